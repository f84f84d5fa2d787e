// Files that are replaced as a whole.
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>

namespace constrictor {

/// Writes a file beside `file` and renames it, so that readers, also those after a loss of power, see either the old or
/// the new content. Throws std::runtime_error.
inline void write_whole(const std::filesystem::path& file, std::string_view content) {
  const std::filesystem::path beside = file.string() + ".part";
  {
    std::ofstream stream(beside, std::ios::binary);
    stream << content;
    if (!stream.flush()) {
      const int error = errno;
      stream.close();
      std::error_code ignored;
      std::filesystem::remove(beside, ignored);
      throw std::runtime_error(fmt::format("cannot write {}: {}", file.string(), std::strerror(error)));
    }
  }
  std::filesystem::rename(beside, file);
}

}  // namespace constrictor
