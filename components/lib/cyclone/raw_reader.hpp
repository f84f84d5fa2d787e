// A reader of any topic, also of types that this program was not compiled with: it passes on the encoded bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "cyclone/discovery.hpp"

namespace constrictor::dds {

/// One sample as it was received.
struct RawSample {
  std::span<const std::uint8_t> bytes;  ///< 4 bytes of encapsulation header, then CDR
  std::int64_t source_time_ns = 0;      ///< [ns] the writer's clock, since 1970
};

class RawReader {
 public:
  /// Matches `writer` and all writers of the same topic and type. Best effort; but if `history` is set and the writer
  /// is reliable and transient-local, the samples that it keeps for late readers arrive first. Never delays a keep-last
  /// writer. Throws Error.
  RawReader(dds_entity_t participant, const Endpoint& writer, bool history);
  /// Takes all samples that have arrived.
  void take(const std::function<void(const RawSample&)>& use) const;
  [[nodiscard]] int writers() const;
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  Entity topic_;
  Entity reader_;
};

}  // namespace constrictor::dds
