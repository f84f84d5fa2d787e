// The groups of programs of the build (scripts/cmake/ProgramGroups.cmake), for programs that were not built.
#pragma once

#include <map>
#include <string>

namespace constrictor::cli {

/// The group of each program that does not belong to the core, whether it was built or not.
[[nodiscard]] const std::map<std::string, std::string>& program_groups();

/// For the end of an error message about a missing program: the program's group, and the command that installs and
/// builds it. Empty for a program of the core and for one that is not of this project.
[[nodiscard]] std::string how_to_build(const std::string& program);

/// Throws ConfigurationError if `program`, a name or a path, is no executable file in program_folder(). The message
/// begins with `where` and ends with how_to_build().
void require_program(const std::string& program, const std::string& where);

/// The same for a component with the program of its own name, but only if it does not belong to the core:
/// constrictor_host names the components that do not exist.
void require_component(const std::string& component);

}  // namespace constrictor::cli
