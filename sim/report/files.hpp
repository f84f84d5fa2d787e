// Files that survive kill -9: an appended journal whose length belongs to the checkpoint, and files replaced as a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace constrictor::report {

/// An append-only file. Its length is part of the component's state: the first append after a restart cuts off what was written
/// after the checkpoint, so that the redone ticks leave the same file.
class Journal {
 public:
  /// An empty path discards everything.
  explicit Journal(std::filesystem::path path) : path_(std::move(path)) {}
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;
  ~Journal();

  /// Writes `text` at `length` and advances `length`. Throws std::runtime_error if the file cannot be written or is shorter than
  /// `length`.
  void append(std::string_view text, std::uint64_t& length);
  /// The first `length` bytes.
  [[nodiscard]] std::string read(std::uint64_t length) const;

 private:
  void open(std::uint64_t length);
  std::filesystem::path path_;
  int descriptor_ = -1;
};

/// Writes a file beside its place and renames it: readers see the old one or the new one. Makes missing folders.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace constrictor::report
