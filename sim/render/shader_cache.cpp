#include "sim/render/shader_cache.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <system_error>
#define XXH_INLINE_ALL  // so that programs that use this library need not link libxxhash
#include <xxhash.h>

namespace constrictor {
namespace {

namespace fs = std::filesystem;

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

/// Whether the path is a folder of this user into which no other user can write.
bool is_private_folder(const fs::path& path) {
  struct stat status {};
  return ::lstat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid() &&
         (status.st_mode & (S_IWGRP | S_IWOTH)) == 0 && ::access(path.c_str(), W_OK | X_OK) == 0;
}

}  // namespace

std::optional<fs::path> cache_root() {
  const std::string service = environment("CACHE_DIRECTORY");
  const std::string home = environment("HOME");
  for (const fs::path& root : {fs::path(service.substr(0, service.find(':'))), fs::path(environment("XDG_CACHE_HOME")),
                               home.empty() ? fs::path() : fs::path(home) / ".cache"}) {
    if (root.is_absolute()) return root;
  }
  return std::nullopt;
}

std::string cpu_features(std::string_view cpuinfo) {
  constexpr std::array<std::string_view, 9> kKeys{"vendor_id", "cpu family",      "model",    "stepping",   "flags",
                                                  "Features",  "CPU implementer", "CPU part", "CPU variant"};
  std::istringstream lines{std::string(cpuinfo)};
  std::string features;
  for (std::string line; std::getline(lines, line) && !line.empty();) {
    const std::string_view key = std::string_view(line).substr(0, line.find_first_of("\t:"));
    if (std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end()) features += line + "\n";
  }
  return features;
}

std::optional<fs::path> shader_cache_folder(const fs::path& root, std::string_view settings) {
  const fs::path folder =
      root / "constrictor" / fmt::format("shaders-{:016x}", XXH3_64bits(settings.data(), settings.size()));
  std::error_code failed;
  if (fs::create_directories(folder, failed)) fs::permissions(folder, fs::perms::owner_all, failed);
  if (failed || !is_private_folder(folder)) return std::nullopt;
  return folder;
}

void set_up_shader_cache() {
  if (std::getenv("MESA_SHADER_CACHE_DISABLE") != nullptr) return;
  std::ifstream file("/proc/cpuinfo");
  std::string settings = cpu_features(std::string(std::istreambuf_iterator<char>(file), {}));
  for (const char* name : {"LP_NATIVE_VECTOR_WIDTH", "GALLIUM_OVERRIDE_CPU_CAPS", "GALLIVM_PERF", "GALLIVM_DEBUG"})
    settings += environment(name) + "\n";
  const std::optional<fs::path> root = cache_root();
  const std::optional<fs::path> folder = root ? shader_cache_folder(*root, settings) : std::nullopt;
  if (!folder) {
    ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    return;
  }
  ::setenv("MESA_SHADER_CACHE_DIR", folder->c_str(), 1);
  ::setenv("MESA_SHADER_CACHE_MAX_SIZE", "64M", 0);
}

}  // namespace constrictor
