#include "runtime/config_hash.hpp"

#include <fstream>
#include <sstream>

#include "constrictor/reflect.hpp"

namespace constrictor {

std::string run_config_hash(const std::filesystem::path& robot_file, const std::vector<std::string>& roster,
                            const std::string& plant) {
  std::ostringstream text;
  if (!robot_file.empty()) text << std::ifstream(robot_file, std::ios::binary).rdbuf();
  text << '\0' << plant;
  for (const auto& name : roster) text << '\0' << name;
  const std::string bytes = std::move(text).str();
  Sha256 hash;
  hash.update(std::as_bytes(std::span(bytes)));
  return hex(hash.finish());
}

}  // namespace constrictor
