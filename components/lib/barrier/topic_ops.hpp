// Operations on a message of any topic, for code that does not know the message's type.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "component/ports.hpp"

namespace constrictor {

struct TopicOps {
  TopicInfo info;
  std::size_t max_size;  ///< [byte] of the C struct
  /// Deep copy with this header and robot id.
  Sample (*stamp)(const void* message, const msg::Header& header, std::uint16_t robot_id);
  /// Deep copy as it is.
  Sample (*copy)(const void* message);
  /// First field that violates its IDL, with what was found and what is accepted; empty if none does.
  std::optional<std::string> (*validate)(const void* message);
  /// Appends the canonical bytes (idl/constrictor/reflect.hpp) of every field.
  void (*append_bytes)(const void* message, std::string& bytes);
  /// The inverse; an empty sample if the bytes are not exactly one message.
  Sample (*parse)(std::span<const std::byte> bytes);
};

/// Throws std::out_of_range unless `topic_id` is below topics::kCount.
const TopicOps& topic_ops(std::size_t topic_id);

}  // namespace constrictor
