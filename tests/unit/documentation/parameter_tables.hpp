// The files that follow from the rows of a component's parameters: its shipped YAML file and the table in its README.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "component/component.hpp"

namespace constrictor {

/// The lines between which the table stands in a README.
inline constexpr const char* kTableBegin = "<!-- Table of parameters, written by the build target parameter_tables -->";
inline constexpr const char* kTableEnd = "<!-- End of the table of parameters -->";

/// The text of the YAML file: each parameter with its default, below a comment with unit, bounds and meaning.
/// `component`: its name. `folder`: where its rows are, relative to the project's root.
std::string yaml_text(const std::string& component, const std::string& folder, const std::vector<ParameterRow>& rows);

/// The table in Markdown, with its head, without the lines kTableBegin and kTableEnd.
std::string markdown_table(const std::vector<ParameterRow>& rows);

/// A file that follows from parameters.
struct DerivedFile {
  std::filesystem::path path;
  std::string text;   ///< as it should be
  std::string error;  ///< why it cannot be derived (a README without the two lines); empty: it can
};

/// The files of all components that have rows: the YAML file, and the README in the same folder. `root`: the source
/// tree. A component whose factory describes no parameters has none.
std::vector<DerivedFile> derived_files(const std::filesystem::path& root);

/// The content of a file; empty if it cannot be read.
std::string content_of(const std::filesystem::path& file);

}  // namespace constrictor
