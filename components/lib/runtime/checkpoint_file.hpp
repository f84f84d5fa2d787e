// The file in which the plant's process keeps its newest checkpoint. Storing one makes no system call: the file is
// mapped into memory, so that its content outlives the process, however that ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "barrier/checkpoint.hpp"

namespace constrictor {

/// Another process has the file open.
class CheckpointInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Two slots take turns. Each names the place of one checkpoint in the rest of the file, and contains its number and
/// checksums. The checkpoint of the other slot is overwritten only after the new one is complete, so that a process
/// that is killed at any point leaves a complete checkpoint. A blob that both checkpoints contain is stored once.
class CheckpointFile {
 public:
  /// Opens `path`, or creates it. Throws std::runtime_error if it cannot be written or if it is not a checkpoint file,
  /// and CheckpointInUse if another process has it open.
  explicit CheckpointFile(std::filesystem::path path);
  ~CheckpointFile();
  CheckpointFile(const CheckpointFile&) = delete;
  CheckpointFile& operator=(const CheckpointFile&) = delete;

  /// The newest complete checkpoint; nothing if none was ever stored. Throws std::runtime_error if both slots are
  /// damaged.
  [[nodiscard]] std::optional<Checkpoint> read();
  /// Stores a checkpoint. Throws std::runtime_error if the file must grow and the disk is full.
  void write(const Checkpoint& checkpoint);
  /// Forgets all checkpoints, as if the file were new.
  void clear();
  /// True if read() found one slot damaged and used the other.
  [[nodiscard]] bool one_slot_damaged() const { return one_slot_damaged_; }
  /// Whether the file was written since this computer was started. After a reboot, the parts of the file may be of
  /// different ages, and only a copy that was synchronised with the disk (store_copy) can be trusted.
  [[nodiscard]] bool of_this_boot() const;
  /// [byte] size of the file.
  [[nodiscard]] std::size_t size() const { return size_; }

  /// Writes a checkpoint as a file of its own and waits until the disk has it. Throws std::runtime_error.
  static void store_copy(const std::filesystem::path& path, const Checkpoint& checkpoint);
  /// Reads such a file; nothing if there is none. Throws std::runtime_error if it is damaged.
  [[nodiscard]] static std::optional<Checkpoint> read_copy(const std::filesystem::path& path);

 private:
  struct Slot;
  struct Part {  ///< a piece of the file
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    std::uint64_t checksum = 0;
  };
  struct Free {  ///< a piece of the file that no checkpoint uses
    std::uint64_t offset;
    std::uint64_t size;
  };
  struct Stored {
    Blob blob;  ///< keeps the address, by which it is found, in use
    Part part;
    std::uint64_t last_used = 0;  ///< newest checkpoint that contains it
  };
  /// Where a blob is stored. If it is not among the first `sorted` ones, it is stored behind the last one.
  Stored& store(const Blob& blob, std::size_t sorted);
  [[nodiscard]] Slot& slot(std::uint64_t number) const;
  [[nodiscard]] std::optional<Checkpoint> read_slot(const Slot& slot, std::map<std::size_t, Part>& parts) const;
  [[nodiscard]] bool holds(const Part& part) const;
  Part put(const char* bytes, std::size_t size);
  [[nodiscard]] std::uint64_t allocate(std::size_t size);
  void release(const Part& part);
  void reserve(const Part& part);
  void add_free(std::uint64_t offset, std::uint64_t size);
  void grow(std::size_t least);

  std::filesystem::path path_;
  int descriptor_ = -1;
  char* data_ = nullptr;
  std::size_t size_ = 0;
  std::uint64_t number_ = 0;    ///< of the newest checkpoint; 0: none
  std::vector<Free> free_;      ///< in the order of their offsets
  std::vector<Stored> stored_;  ///< in the order of their blobs' addresses
  Part table_of_last_, table_of_last_but_one_;
  std::string table_;
  bool one_slot_damaged_ = false;
};

}  // namespace constrictor
