// What the runtime can do with a message of any topic without knowing its type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "runtime/ports.hpp"

namespace constrictor {

struct TopicOps {
  TopicInfo info;
  std::size_t max_size;  ///< [byte] of the C struct
  /// Deep copy with this header and robot.
  Sample (*stamp)(const void* message, const msg::Header& header, std::uint16_t robot_id);
  /// Deep copy as it is.
  Sample (*copy)(const void* message);
  /// First violated field, if any.
  std::optional<std::string> (*validate)(const void* message);
  /// Appends every field as deterministic bytes; see idl/constrictor/reflect.hpp.
  void (*append_bytes)(const void* message, std::string& bytes);
  /// The inverse; empty if the bytes are not exactly one message.
  Sample (*parse)(std::span<const std::byte> bytes);
};

/// By topic id, which must be below topics::kCount.
const TopicOps& topic_ops(std::size_t topic_id);

}  // namespace constrictor
