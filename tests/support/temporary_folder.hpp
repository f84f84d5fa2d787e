// A folder that is removed at the end of its test.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "configuration/temporary_folder.hpp"

namespace constrictor::testing {

class TemporaryFolder : public constrictor::TemporaryFolder {
 public:
  TemporaryFolder() : constrictor::TemporaryFolder("test") {}

  /// The content of every file in the folder, by its path inside the folder.
  [[nodiscard]] std::map<std::string, std::string> contents() const {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path())) {
      if (!entry.is_regular_file()) continue;
      std::ifstream file(entry.path(), std::ios::binary);
      files[std::filesystem::relative(entry.path(), path()).string()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return files;
  }
};

}  // namespace constrictor::testing
