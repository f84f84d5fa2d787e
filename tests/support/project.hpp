// Where the files of the project are. The paths are compiled into one object, so that the objects of all tests are the
// same in every checkout and a compiler cache serves them all.
#pragma once

#include <filesystem>
#include <string>

namespace constrictor::testing {

/// A file or folder of the source tree: `relative` is its path from the root; empty: the root.
[[nodiscard]] std::filesystem::path source_path(const std::filesystem::path& relative = {});
/// The same in the folder of the build.
[[nodiscard]] std::filesystem::path build_path(const std::filesystem::path& relative = {});
/// The file of a robot that is delivered with the project: "mamba", "serpens" ...
[[nodiscard]] std::filesystem::path robot_path(const std::string& name);
/// A program of the build: "constrictor", "physics" ...
[[nodiscard]] std::string program(const std::string& name);

}  // namespace constrictor::testing
