// Files that are replaced as a whole.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

namespace constrictor {

/// A new file: it is written beside `file`, as part(), and gets its name when it is complete. Until then an older file
/// stays what it is, and nothing is left of one that is given up.
class NewFile {
 public:
  explicit NewFile(std::filesystem::path file) : NewFile(std::move(file), ".part") {}
  /// The same with a part() that no other process writes: whichever completes the file last determines its content.
  static NewFile of_this_process(std::filesystem::path file) {
    return {std::move(file), fmt::format(".{}.part", ::getpid())};
  }
  ~NewFile() {
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;
  [[nodiscard]] const std::filesystem::path& part() const { return part_; }
  /// To be called when part() is closed. Throws std::filesystem::filesystem_error.
  void complete() { std::filesystem::rename(part_, file_); }

 private:
  NewFile(std::filesystem::path file, const std::string& ending)
      : file_(std::move(file)), part_(file_.string() + ending) {}
  std::filesystem::path file_, part_;
};

/// Writes a file beside `file` and renames it, so that readers, also those after a loss of power, see either the old or
/// the new content. Throws std::system_error.
inline void write_whole(const std::filesystem::path& file, std::string_view content) {
  NewFile whole(file);
  {
    std::ofstream stream(whole.part(), std::ios::binary);
    stream << content;
    if (!stream.flush())
      throw std::system_error(errno, std::generic_category(), fmt::format("cannot write {}", file.string()));
  }
  whole.complete();
}

}  // namespace constrictor
