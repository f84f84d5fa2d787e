// New folders for files that are needed for a while.
#pragma once

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace constrictor {

/// An empty folder of its own, constrictor-PURPOSE-..., below the folder for temporary files. The destructor removes it
/// with its content.
class TemporaryFolder {
 public:
  /// Throws std::system_error.
  explicit TemporaryFolder(const std::string& purpose) {
    std::string name = (std::filesystem::temp_directory_path() / ("constrictor-" + purpose + "-XXXXXX")).string();
    if (!::mkdtemp(name.data()))
      throw std::system_error(errno, std::generic_category(), "cannot make the folder " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!kept_) std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// After this call, the destructor does not remove the folder.
  void keep() { kept_ = true; }

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

}  // namespace constrictor
