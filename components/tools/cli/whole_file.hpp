// Files that are replaced as a whole.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace constrictor::cli {

/// Writes the file at once: after a loss of power there is the old one or the new one. Throws std::runtime_error.
inline void write_whole(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path beside = file.string() + ".part";
  {
    std::ofstream stream(beside, std::ios::binary);
    stream << text;
    if (!stream.flush()) throw std::runtime_error(fmt::format("cannot write {}", beside.string()));
  }
  std::filesystem::rename(beside, file);
}

}  // namespace constrictor::cli
