#include "component/data_path.hpp"

#include <cstdlib>

namespace constrictor {

std::filesystem::path data_path(const std::filesystem::path& relative) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (const char* folder = std::getenv("CONSTRICTOR_DATA")) {
    const fs::path candidate = fs::path(folder) / relative;
    if (fs::exists(candidate, error)) return candidate;
  }
  // An installed program (PREFIX/libexec/constrictor/NAME) uses its own prefix, also if the source tree still exists.
  const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path().parent_path();
  const fs::path installed = prefix / "share/constrictor" / relative;
  if (fs::exists(installed, error)) return installed;
  return fs::path(CONSTRICTOR_SOURCE_DIR) / relative;
}

}  // namespace constrictor
