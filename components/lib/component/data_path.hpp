// Finds the project's data files: robots, scenarios, default configurations, manifests.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace constrictor {

/// The folders in which data files are searched, the first one first: $CONSTRICTOR_DATA; for an installed program the
/// files that belong to this host (/etc/constrictor for the prefix /usr, etc/constrictor of any other prefix) and
/// share/constrictor of its prefix; for another program the source tree. Only folders that exist.
[[nodiscard]] std::vector<std::filesystem::path> data_folders();

/// Path of a file that is given relative to the project's root, for example
/// "components/control/control.yaml": that of the first of data_folders() that has it. Returns a path in the source
/// tree if none has it.
[[nodiscard]] std::filesystem::path data_path(const std::filesystem::path& relative);

/// The robot and the scenario of a process that is started without naming one.
[[nodiscard]] std::filesystem::path default_robot_file();
[[nodiscard]] std::filesystem::path default_scenario_file();

/// The names, without ".yaml", of the YAML files in this folder of the data_folders(), sorted.
[[nodiscard]] std::vector<std::string> data_names(const std::filesystem::path& relative);

}  // namespace constrictor
