// The descriptions of messages, their fields and constants in the generated header constrictor/messages.hpp.
#pragma once

#include <cstddef>
#include <span>

namespace constrictor {

/// Constants of the IDL whose names begin alike, e.g. kColourUnknown, kColourGreen, ...; see constrictor/constants.hpp.
struct ConstantGroup {
  const char* prefix;                  ///< "kColour"
  std::span<const char* const> names;  ///< by value: "unknown", "green", ...
};

/// The description of one field in the IDL.
struct FieldInfo {
  const char* name;
  const char* unit;  ///< without brackets; may be empty
  const char* doc;   ///< the comment
  bool has_range;
  double min;
  double max;
  bool nan_allowed;  ///< NaN means "unknown" here
  bool is_key;
  const ConstantGroup* constants;  ///< the field holds one of these; null: any number
};

/// Name, documentation and fields of a message type.
template <class Message>
struct Description;

template <class... Messages>
struct TypeList {};

}  // namespace constrictor
