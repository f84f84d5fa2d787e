// The messages of this project in CDR (OMG DDSI-RTPS, classic CDR = XCDR1), made from their canonical bytes
// (constrictor/reflect.hpp) and the reverse: for recordings of messages that do not come from DDS.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "constrictor/reflect.hpp"
#include "recording/mcap_format.hpp"

namespace constrictor {

struct MessageCodec {
  std::string_view type;  ///< name of the IDL type, without modules
  /// Appends the encapsulation header (little-endian) and the CDR of a message with these canonical bytes. Returns
  /// false if they are not exactly one message.
  bool (*to_cdr)(mcap::Bytes canonical, std::string& cdr);
  /// The same, but sequences of octets (the pixels of an image) become empty.
  bool (*to_cdr_without_octets)(mcap::Bytes canonical, std::string& cdr);
  /// Appends the canonical bytes of a message with this CDR, encapsulation header included. Returns false if the CDR is
  /// not exactly one message, or not little-endian.
  bool (*from_cdr)(mcap::Bytes cdr, std::string& canonical);
  /// The header of a message with this CDR; nothing if the type has no header, or the CDR is too short for it.
  std::optional<msg::Header> (*header)(mcap::Bytes cdr);
  /// The type in the language of ROS 2's message files, as TypeTree::ros2_schema() makes it of the type's description.
  std::string (*schema)();
};

/// "constrictor/msg/JointState".
[[nodiscard]] inline std::string schema_name(std::string_view type) { return "constrictor/msg/" + std::string(type); }

/// The codec of a type of topic_table.def; null if no topic has this type.
[[nodiscard]] const MessageCodec* find_codec(std::string_view type);

/// The CDR of a message, encapsulation header included.
template <Described T>
[[nodiscard]] std::string cdr_of(const T& message) {
  std::string canonical;
  canonical_bytes(message, canonical);
  std::string cdr;
  find_codec(Description<T>::kName)->to_cdr(mcap::bytes_of(canonical), cdr);
  return cdr;
}

/// The message of this CDR; null if it is not exactly one message of this type.
template <Described T>
[[nodiscard]] std::shared_ptr<const T> message_of(mcap::Bytes cdr) {
  std::string canonical;
  if (!find_codec(Description<T>::kName)->from_cdr(cdr, canonical)) return nullptr;
  return parse_shared<T>(std::as_bytes(std::span(canonical)));
}

}  // namespace constrictor
