// What every member wrote in each tick, as hashes (and, if asked, as the messages themselves): what `constrictor diff`
// compares. Written by the plant's host, which sees every checkpoint anyway.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "runtime/ports.hpp"

namespace constrictor {

class HashLog {
 public:
  struct Entry {
    std::int64_t tick;
    std::uint64_t sequence_number;
    std::uint8_t topic;
    std::uint64_t hash;             ///< first 8 bytes of the SHA-256 of the message with a neutral header
    std::string bytes;              ///< canonical bytes; empty if not recorded
  };

  /// Creates `directory`/hashes.bin. Throws std::runtime_error if that fails.
  HashLog(const std::filesystem::path& directory, bool record);
  /// A new epoch: the log begins anew.
  void restart();
  void add(const TopicInfo& topic, const Sample& sample);
  /// The same for a message that came as canonical bytes.
  void add(std::uint8_t topic, const std::string& bytes);
  void close() { file_.close(); }

  /// Reads a log, ordered by (tick, topic, sequence). A half-written last entry is left out. Throws std::runtime_error.
  static std::vector<Entry> read(const std::filesystem::path& directory);

 private:
  std::filesystem::path path_;
  std::ofstream file_;
  bool record_;
};

}  // namespace constrictor
