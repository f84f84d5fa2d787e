#include "support/project.hpp"

namespace constrictor::testing {

std::filesystem::path source_path(const std::filesystem::path& relative) {
  return relative.empty() ? std::filesystem::path(PROJECT_SOURCE_DIR) : PROJECT_SOURCE_DIR / relative;
}

std::filesystem::path build_path(const std::filesystem::path& relative) {
  return relative.empty() ? std::filesystem::path(PROJECT_BINARY_DIR) : PROJECT_BINARY_DIR / relative;
}

std::filesystem::path robot_path(const std::string& name) {
  return source_path("components/lib/robot/" + name + ".yaml");
}

std::string program(const std::string& name) { return build_path("bin/" + name); }

}  // namespace constrictor::testing
