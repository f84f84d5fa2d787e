// A file with the hash of every message that the members wrote, by tick, and on request the messages themselves:
// `constrictor diff` compares two of them. The plant's process writes it, since it receives every checkpoint.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "component/ports.hpp"
#include "constrictor/sha256.hpp"

namespace constrictor {

class HashLog {
 public:
  struct Entry {
    std::int64_t tick;
    std::uint64_t sequence_number;
    std::uint8_t topic;
    std::uint64_t hash;  ///< first 8 bytes of the SHA-256 of the message with a neutral header
    std::string bytes;   ///< canonical bytes of the message; empty if they were not recorded
  };

  /// Creates `directory`/hashes.bin. Throws std::runtime_error if that fails.
  HashLog(const std::filesystem::path& directory, bool record);
  /// A new epoch begins: empties the log.
  void restart();
  void add(const TopicInfo& topic, const Sample& sample);
  /// Adds a message that is given as canonical bytes; one that is too short for its header is ignored.
  void add(std::uint8_t topic, const std::string& bytes);
  void close() { file_.close(); }

  /// Reads a log, ordered by tick, topic and sequence number. An incomplete last entry is skipped. Throws
  /// std::runtime_error if the file is missing or damaged.
  static std::vector<Entry> read(const std::filesystem::path& directory);

 private:
  std::filesystem::path path_;
  std::ofstream file_;
  bool record_;
  Sha256 hash_;
};

}  // namespace constrictor
