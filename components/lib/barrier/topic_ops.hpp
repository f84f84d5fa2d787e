// Operations on a message of any topic, for code that does not know the message's type.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "component/ports.hpp"
#include "constrictor/compare.hpp"

namespace constrictor {

inline constexpr std::size_t kHeaderSize = 40;  ///< [byte] length of a header in canonical bytes
using HeaderBytes = std::array<std::byte, kHeaderSize>;

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
  /// Offset of the header in a message's canonical bytes, so that they can be hashed with another header without a copy
  /// of the message; empty if they are too short for it. The first two bytes are the robot id.
  std::optional<std::size_t> (*header_at)(std::span<const std::byte> bytes);
  /// The inverse of append_bytes; an empty sample if the bytes are not exactly one message.
  Sample (*parse)(std::span<const std::byte> bytes);
  /// The first field in which two messages differ; nothing if they are equal.
  std::optional<FieldDifference> (*difference)(const void* a, const void* b);
};

/// Throws std::out_of_range unless `topic_id` is below topics::kCount.
const TopicOps& topic_ops(std::size_t topic_id);

/// The header for hashes that must be equal in all runs with the same result: without the random run id, and without
/// the numbers of epoch and incarnation.
[[nodiscard]] msg::Header neutral_header(msg::Header header);
/// A message, given as canonical bytes, with a neutral header and robot id 0. Bytes that are too short for a header
/// stay as they are.
[[nodiscard]] std::string neutral_message(std::size_t topic_id, std::string bytes);
/// The canonical bytes of a header.
[[nodiscard]] HeaderBytes header_bytes(const msg::Header& header);
/// The inverse.
[[nodiscard]] msg::Header parse_header(std::span<const std::byte, kHeaderSize> bytes);

}  // namespace constrictor
