// Hashes of the configuration. They must be equal in all processes of a run, and in a process before and after a
// restart.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace constrictor {

/// SHA-256 in hexadecimal over the robot file's bytes, the roster, the plant's name, the latencies that the
/// manifest sets [ticks, by member], and the file of faults. An empty path counts as an empty file.
std::string run_config_hash(const std::filesystem::path& robot_file, const std::vector<std::string>& roster,
                            const std::string& plant, const std::map<std::string, std::uint16_t>& latency_ticks = {},
                            const std::filesystem::path& faults_file = {});

/// SHA-256 in hexadecimal over the bytes of a component's own configuration file and of the scenario file. A file that
/// does not exist counts as empty.
std::string component_config_hash(const std::filesystem::path& config_file, const std::filesystem::path& scenario_file);

}  // namespace constrictor
