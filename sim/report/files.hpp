// Files that stay consistent when the process is killed: journals whose length belongs to the checkpoint, and files
// that are replaced as a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace constrictor::report {

/// A file to which lines are appended. Its length belongs to the state of the component. After a restart, the first
/// append removes all lines that were written after the checkpoint; the component repeats those ticks and writes the
/// same lines again.
class Journal {
 public:
  /// If `path` is empty, the journal writes no file and discards its lines.
  explicit Journal(std::filesystem::path path) : path_(std::move(path)) {}
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  /// Writes `text` at `length` and advances `length`. Throws std::runtime_error if the file cannot be written or is
  /// shorter than `length`.
  void append(std::string_view text, std::uint64_t& length);
  /// The first `length` bytes.
  [[nodiscard]] std::string read(std::uint64_t length) const;

 private:
  void open(std::uint64_t length);
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Writes a temporary file and renames it, so that readers see either the old or the new file. Creates missing folders.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace constrictor::report
