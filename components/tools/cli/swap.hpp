// The file of `constrictor swap` in the report directory of a run: it names the program that takes the place of a
// process's own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/manifest.hpp"

namespace constrictor::cli {

struct Swap {
  std::string program;           ///< of this build, or an absolute path
  std::filesystem::path config;  ///< of its component; empty: the default
};

/// Throws std::runtime_error if the file cannot be written.
void write_swap(const std::filesystem::path& report_dir, const ProcessPlan& process, const Swap& swap);
/// Empty: the process has its own program.
[[nodiscard]] std::optional<Swap> read_swap(const std::filesystem::path& report_dir, const ProcessPlan& process);
/// Removes what an earlier run in this directory has left.
void remove_swaps(const std::filesystem::path& report_dir);

/// The same command line, but with the program that the user has given to `constrictor swap`, if there is one.
[[nodiscard]] CommandLine with_swaps(CommandLine command_line, const std::filesystem::path& report_dir);

}  // namespace constrictor::cli
