// Files that stay consistent when the process is killed: journals whose length belongs to the checkpoint, and files
// that are replaced as a whole.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

#include "log/log.hpp"

namespace constrictor::report {

/// A file that cannot be written: the disk is full, or the folder has been removed.
class NotWritten : public std::runtime_error {
 public:
  NotWritten(std::filesystem::path path, const std::string& reason)
      : std::runtime_error("cannot write " + path.string() + ": " + reason), path_(std::move(path)) {}
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The files that could not be written. The mission goes on without them, and each is logged once.
class LostFiles {
 public:
  explicit LostFiles(Log log) : log_(std::move(log)) {}
  /// Calls `write`. Returns false if it throws NotWritten.
  template <class Write>
  bool attempt(Write&& write) {
    try {
      write();
      return true;
    } catch (const NotWritten& error) {
      note(error);
      return false;
    }
  }
  /// The reasons, by file.
  [[nodiscard]] const std::map<std::filesystem::path, std::string>& reasons() const { return reasons_; }

 private:
  void note(const NotWritten& error);
  Log log_;
  std::map<std::filesystem::path, std::string> reasons_;
};

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

  /// Writes `text` at `length` and advances `length`. Throws NotWritten if the file cannot be written; it then ends
  /// here, and later calls do nothing. Throws std::runtime_error if it is shorter than `length`.
  void append(std::string_view text, std::uint64_t& length);
  /// The first `length` bytes.
  [[nodiscard]] std::string read(std::uint64_t length) const;

 private:
  void open(std::uint64_t length);
  std::filesystem::path path_;
  int descriptor_ = -1;
  bool ended_ = false;  ///< by a line that could not be written: a file with a gap would mislead
};

/// Writes a temporary file and renames it, so that readers see either the old or the new file. Creates missing folders.
/// Throws NotWritten.
void replace_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace constrictor::report
