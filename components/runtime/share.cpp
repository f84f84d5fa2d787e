#include "runtime/share.hpp"

#include <cstdlib>

namespace constrictor {

std::filesystem::path share_path(const std::filesystem::path& relative) {
  namespace fs = std::filesystem;
  if (const char* share = std::getenv("CONSTRICTOR_SHARE")) {
    const fs::path candidate = fs::path(share) / relative;
    if (fs::exists(candidate)) return candidate;
  }
  const fs::path source = fs::path(CONSTRICTOR_SOURCE_DIR) / relative;
  std::error_code error;
  if (fs::exists(source, error)) return source;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  const fs::path installed = executable.parent_path().parent_path() / "share/constrictor" / relative;
  return fs::exists(installed, error) ? installed : source;
}

}  // namespace constrictor
