// A file that is read and written at given places. All functions throw Error with the file's name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "recording/mcap_format.hpp"

namespace constrictor::mcap {

/// The disk is full, or a quota or limit of the file's size is reached.
class DiskFull : public Error {
 public:
  using Error::Error;
};

class File {
 public:
  enum class Mode {
    kRead,
    kCreate,  ///< empty, readable by its owner only
    kChange,  ///< of an existing file
  };
  /// A file that is written is locked until this object is destroyed: a second writer is refused.
  File(std::filesystem::path path, Mode mode);
  ~File();
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::uint64_t size() const;
  /// Reads up to `size` bytes; fewer at the end of the file.
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t size) const;
  /// Throws DiskFull if there is no space; part of the bytes may have been written then.
  void write(std::uint64_t offset, std::string_view bytes) const;
  void truncate(std::uint64_t size) const;
  /// Reserves space on the disk beyond the end of the file, whose size stays. Throws DiskFull if there is none. Does
  /// nothing on file systems without this function.
  void reserve(std::uint64_t offset, std::uint64_t size) const;
  /// Throws DiskFull if others would find less than `size` bytes on the disk after `more` bytes of this file.
  void leave_free(std::uint64_t size, std::uint64_t more) const;

 private:
  [[noreturn]] void fail(const char* what, int error) const;
  std::filesystem::path path_;
  int descriptor_ = -1;
};

}  // namespace constrictor::mcap
