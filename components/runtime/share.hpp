// Where the project's data files are: robots, scenarios, default configurations, manifests.
#pragma once

#include <filesystem>

namespace constrictor {

/// Absolute path of a file given relative to the project's root, e.g. "components/control/control.yaml": looked up in
/// $CONSTRICTOR_SHARE, then in the source tree this was built from, then beside the executable's ../share/constrictor.
/// Returns the first that exists, else the source tree's (so that the error message names a path).
std::filesystem::path share_path(const std::filesystem::path& relative);

}  // namespace constrictor
