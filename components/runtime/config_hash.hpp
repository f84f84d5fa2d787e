// What all processes of a run must have in common.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace constrictor {

/// SHA-256, as hex, over the robot file's bytes, the roster and the plant's name. A component without a robot file
/// (an empty path) counts it as empty.
std::string run_config_hash(const std::filesystem::path& robot_file, const std::vector<std::string>& roster,
                            const std::string& plant);

/// SHA-256, as hex, over the bytes of a component's own configuration file and the scenario's; a file that is not there counts as empty.
std::string component_config_hash(const std::filesystem::path& config_file, const std::filesystem::path& scenario_file);

}  // namespace constrictor
