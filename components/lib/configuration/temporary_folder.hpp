// New folders for files that are needed for a while.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace constrictor {

/// Makes an empty folder of its own, constrictor-PURPOSE-..., below the folder for temporary files. The caller removes
/// it. Throws std::system_error.
[[nodiscard]] inline std::filesystem::path new_temporary_folder(const std::string& purpose) {
  std::string name = (std::filesystem::temp_directory_path() / ("constrictor-" + purpose + "-XXXXXX")).string();
  if (!::mkdtemp(name.data()))
    throw std::system_error(errno, std::generic_category(), "cannot make the folder " + name);
  return name;
}

}  // namespace constrictor
