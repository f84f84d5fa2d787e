// Reads the log lines of all processes of a domain.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "constrictor/messages.hpp"
#include "cyclone/entity.hpp"

namespace constrictor {

/// Receives the lines that living processes keep for late readers (the newest 256 of each), and then all new ones.
/// Never delays a writer: of the lines that this reader does not take in time, the oldest are dropped and counted.
class LogReader {
 public:
  /// `lost`: number of lines of the same process just before this one that never arrived.
  using Use = std::function<void(const msg::LogLine& line, std::uint64_t lost)>;

  /// `participant` must outlive this object. Throws dds::Error.
  explicit LogReader(dds_entity_t participant);
  /// Takes the lines that have arrived; those of one process are in their order. Lines that violate the IDL are left
  /// out. The texts contain no control characters.
  void take(const Use& use);
  /// Whether every process whose writer this reader has met has delivered a line; each process writes one at its start.
  [[nodiscard]] bool heard_all() const;

 private:
  dds::Entity reader_;
  std::map<std::pair<std::string, std::int32_t>, std::uint64_t> newest_;  ///< number of the newest line by host and pid
};

}  // namespace constrictor
