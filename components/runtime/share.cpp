#include "runtime/share.hpp"

#include <cstdlib>

namespace constrictor {

std::filesystem::path share_path(const std::filesystem::path& relative) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (const char* share = std::getenv("CONSTRICTOR_SHARE")) {
    const fs::path candidate = fs::path(share) / relative;
    if (fs::exists(candidate, error)) return candidate;
  }
  // An installed program keeps to its own prefix, also where the source tree still exists: PREFIX/libexec/constrictor/NAME.
  const fs::path prefix = fs::read_symlink("/proc/self/exe", error).parent_path().parent_path().parent_path();
  const fs::path installed = prefix / "share/constrictor" / relative;
  if (fs::exists(installed, error)) return installed;
  return fs::path(CONSTRICTOR_SOURCE_DIR) / relative;
}

}  // namespace constrictor
