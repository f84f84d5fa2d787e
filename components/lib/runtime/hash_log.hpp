// A file with the hash of every message that the members wrote, by tick: `constrictor diff` compares two of them. The
// plant's process writes it, since it receives every checkpoint.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "component/ports.hpp"

namespace constrictor {

class MessageHasher;

class HashLog {
 public:
  struct Entry {
    std::int64_t tick;
    std::uint64_t sequence_number;
    std::uint8_t topic;
    std::uint64_t hash;  ///< XXH3 of the message with a neutral header
    std::string bytes;   ///< canonical bytes of the message, if the caller has them; a hash log has none
  };

  /// Creates `directory`/hashes.bin. `length`: a successor continues the file of its predecessor after this many bytes.
  /// Throws std::runtime_error if that fails.
  explicit HashLog(const std::filesystem::path& directory, std::optional<std::uint64_t> length = {});
  ~HashLog();
  HashLog(const HashLog&) = delete;
  HashLog& operator=(const HashLog&) = delete;
  /// A new epoch begins: empties the log.
  void restart();
  void add(const TopicInfo& topic, const Sample& sample);
  /// Adds a message that is given as canonical bytes; one that is too short for its header is ignored.
  void add(std::uint8_t topic, const std::string& bytes);
  /// Writes to the file what was added. If the disk is full, the log ends here, and the file says so. Returns the
  /// error, once; empty: none.
  std::string flush();
  /// [byte] length of the file after flush().
  [[nodiscard]] std::uint64_t length() const { return length_; }

  /// Reads a log, ordered by tick, topic and sequence number. An incomplete last entry is skipped. Throws
  /// std::runtime_error if the file is missing or damaged.
  static std::vector<Entry> read(const std::filesystem::path& directory);
  /// The tick at which the disk was full, after which the log has no entries; nothing if the log is complete.
  static std::optional<std::int64_t> full_disk_at(const std::filesystem::path& directory);

 private:
  void write_header(std::int64_t incomplete_from) const;
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::string buffer_;   ///< not yet in the file
  std::string message_;  ///< the bytes of one
  std::uint64_t length_ = 0;
  std::int64_t newest_tick_ = 0;
  bool full_ = false;
  std::unique_ptr<MessageHasher> hasher_;
};

/// Hashes messages as the hash log does: with XXH3, which finds differences of runs, but resists no forgery. A
/// cryptographic hash of all pixels would cost a noticeable part of a run.
class MessageHasher {
 public:
  MessageHasher();
  ~MessageHasher();
  MessageHasher(const MessageHasher&) = delete;
  MessageHasher& operator=(const MessageHasher&) = delete;
  /// The XXH3 of a message of a topic, given as canonical bytes, with a neutral header and robot id 0, and its tick and
  /// sequence number; nothing if the bytes are too short for a header.
  [[nodiscard]] std::optional<HashLog::Entry> entry_of(std::uint8_t topic, const std::string& bytes);

 private:
  void* state_;
};

}  // namespace constrictor
