// The git revision of the source tree. Only programs made with constrictor_git_revision() (CMake) contain it;
// own_git_revision() of version_text.hpp can be used in all.
#pragma once

namespace constrictor {

/// "0a1b2c3d4e5f of 2026-11-22", with a remark if files were changed after the commit.
extern const char* const kGitRevision;
/// Date of the commit; empty if it is not known.
extern const char* const kGitDate;

}  // namespace constrictor
