// Where the project's data files are: robots, scenarios, default configurations, manifests.
#pragma once

#include <filesystem>

namespace constrictor {

/// Absolute path of a file given relative to the project's root, e.g. "components/control/control.yaml": the first that exists in
/// $CONSTRICTOR_SHARE, in share/constrictor of the prefix that the program is installed in, else the source tree's (also if it
/// does not exist there, so that the error message names a path).
std::filesystem::path share_path(const std::filesystem::path& relative);

}  // namespace constrictor
