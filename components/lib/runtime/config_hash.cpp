#include "runtime/config_hash.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "barrier/protocol.hpp"
#include "constrictor/hex.hpp"
#include "constrictor/reflect.hpp"
#include "constrictor/sha256.hpp"

namespace constrictor {
namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ostringstream text;
  if (!file.empty()) text << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(text).str();
}

std::string hash_of(const std::string& bytes) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(bytes)));
  return hex(hash.finish());
}

}  // namespace

std::string run_config_hash(const std::filesystem::path& robot_file, const std::vector<std::string>& roster,
                            const std::string& plant, const std::map<std::string, std::uint16_t>& latency_ticks,
                            const std::filesystem::path& faults_file) {
  std::string bytes = bytes_of(robot_file) + '\0' + plant;
  for (const auto& name : roster) {
    bytes += '\0';
    bytes += name;
  }
  for (const auto& [name, ticks] : latency_ticks) {
    bytes += '\0';
    bytes += fmt::format("{}={}", name, ticks);
  }
  if (!faults_file.empty()) bytes += '\0' + bytes_of(faults_file);
  return hash_of(bytes);
}

std::string component_config_hash(const std::filesystem::path& config_file,
                                  const std::filesystem::path& scenario_file) {
  return component_hash(hash_of(bytes_of(scenario_file)), hash_of(bytes_of(config_file)));
}

}  // namespace constrictor
