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

}  // namespace constrictor
