// The fields of all messages as a table, for programs that know the type of a message by its name only.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "constrictor/description.hpp"

namespace constrictor {

/// One field of a message type, as the IDL describes it.
struct FieldEntry {
  FieldInfo info;
  std::string_view type;   ///< IDL name of the type that it contains ("constrictor::msg::Blob"); empty: no structure
  std::size_t length = 0;  ///< of an array; 0: not an array
  /// For an array: index of the field ..._count before it, the number of elements that are used; -1: all are used.
  std::ptrdiff_t count_at = -1;
};

/// The fields of the message type with this IDL name ("constrictor::msg::Blob"), in their order. Null if the project
/// defines no such type.
[[nodiscard]] const std::vector<FieldEntry>* fields_of(std::string_view type);

}  // namespace constrictor
