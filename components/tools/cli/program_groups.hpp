// The groups of programs of the build (scripts/cmake/ProgramGroups.cmake), for programs that were not built.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace constrictor::cli {

/// The group of each program that does not belong to the core, whether it was built or not.
[[nodiscard]] const std::map<std::string, std::string>& program_groups();

/// The error message for a program that does not exist: its group, and the command that installs and builds the group;
/// for a program of the core, and for one that is not of this project, what was found and what is accepted.
[[nodiscard]] std::string missing_program(const std::string& program);

/// Whether the file exists, is not a folder, and may be executed.
[[nodiscard]] bool is_executable(const std::filesystem::path& file);

/// Throws ConfigurationError if `program`, a name or a path, is not an executable file in program_folder(). The message
/// begins with `where`, followed by missing_program().
void require_program(const std::string& program, const std::string& where);

/// Whether this build contains a component of the project: the group of its program was built, or it is of the core.
[[nodiscard]] bool is_built(const std::string& component);

/// Throws ConfigurationError with missing_program() if the component belongs to a group that was not built.
void require_component(const std::string& component);

}  // namespace constrictor::cli
