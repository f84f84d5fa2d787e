// A writer of samples that are given as encoded bytes, of any type, also of types that this program was not compiled
// with.
#pragma once

#include <chrono>
#include <cstdint>
#include <span>
#include <string>

#include "cyclone/raw_type.hpp"

namespace constrictor::dds {

class RawWriter {
 public:
  struct Type {
    std::string name;  ///< DDS name, "constrictor::msg::JointState"
    bool keyed = true;
    bool xcdr2 = false;  ///< the encoding of the samples
  };
  /// Reliable, transient-local, keep-last `depth`: late readers receive the last samples. All instances count as one.
  /// Announces no type information. Throws Error.
  RawWriter(dds_entity_t participant, const std::string& topic, const Type& type, int depth);
  /// Writes a sample with its encapsulation header. Never blocks. Throws Error.
  void write(std::span<const std::uint8_t> cdr) const;
  [[nodiscard]] int readers() const;
  /// Waits until the reliable readers have acknowledged everything that was written. False if they have not within
  /// `bound`.
  [[nodiscard]] bool flush(std::chrono::milliseconds bound) const;

 private:
  RawTopic topic_;
  Entity writer_;
};

}  // namespace constrictor::dds
