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

/// The QoS that a RawReader requests from writers.
struct RawQos {
  bool reliable = false;
  bool transient_local = false;  ///< the samples that the writers keep for late readers arrive first
  bool keep_all = false;         ///< keeps all samples until they are taken; else the last 1,024
};

class RawReader {
 public:
  /// Matches all writers of the writer's topic and type that offer these qualities. Throws Error.
  RawReader(dds_entity_t participant, const Endpoint& writer, RawQos wanted);
  /// Matches `writer` and all writers of the same topic and type. Best effort; but if `history` is set and the writer
  /// is reliable and transient-local, the samples that it keeps for late readers arrive first. Never delays a keep-last
  /// writer. Throws Error.
  RawReader(dds_entity_t participant, const Endpoint& writer, bool history);
  /// Takes all samples that have arrived.
  void take(const std::function<void(const RawSample&)>& use) const;
  [[nodiscard]] int writers() const;
  /// Number of samples that writers had replaced by newer ones before they arrived here.
  [[nodiscard]] std::uint64_t lost() const;
  [[nodiscard]] dds_entity_t get() const { return reader_.get(); }

 private:
  Entity topic_;
  Entity reader_;
};

}  // namespace constrictor::dds
