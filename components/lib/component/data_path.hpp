// Finds the project's data files: robots, scenarios, default configurations, manifests.
#pragma once

#include <filesystem>

namespace constrictor {

/// Absolute path of a file that is given relative to the project's root, for example
/// "components/control/control.yaml". Looks in $CONSTRICTOR_DATA, then in share/constrictor of the prefix that the
/// program is installed in. Returns a path in the source tree if neither has the file, also if it does not exist there.
std::filesystem::path data_path(const std::filesystem::path& relative);

}  // namespace constrictor
