// A reader of any topic, also of types that this program was never compiled with: it hands over the encoded bytes.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "runtime/dds/discovery.hpp"

namespace constrictor::dds {

/// One sample as it came over the wire.
struct RawSample {
  std::span<const std::uint8_t> bytes;  ///< 4 bytes of encapsulation header, then CDR
  std::int64_t source_time_ns = 0;      ///< [ns] the writer's clock, since 1970
};

class RawReader {
 public:
  /// For writers like `writer`. Best effort, unless `history` and the writer is transient-local: then what it keeps for late
  /// readers arrives first. Never holds a keep-last writer up. Throws Error.
  RawReader(dds_entity_t participant, const Endpoint& writer, bool history);
  /// Takes everything there is.
  void take(const std::function<void(const RawSample&)>& use) const;
  [[nodiscard]] int writers() const;
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  Entity topic_;
  Entity reader_;
};

}  // namespace constrictor::dds
