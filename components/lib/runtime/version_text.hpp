// The output of --version.
#pragma once

#include <string>

namespace constrictor {

/// The release in the first line, "constrictor 0.1.0", then the git revision if it is given, the hash of the IDL files
/// (processes with different ones refuse each other), and the Cyclone DDS library that this process has loaded.
[[nodiscard]] std::string version_text(const std::string& program, const std::string& git_revision = {});

/// kGitRevision of this program; "not known: ..." if it was made without constrictor_git_revision() (CMake), as
/// programs of other projects are.
[[nodiscard]] std::string own_git_revision();

}  // namespace constrictor
