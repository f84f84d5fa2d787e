// The primitive types in descriptions of types, and their sizes in CDR.
#pragma once

#include <cstddef>
#include <cstdint>

namespace constrictor::dds::primitives {

/// DDS_XTypes_TK_...
enum Primitive : std::uint8_t {
  kBoolean = 1,
  kByte = 2,
  kInt16 = 3,
  kInt32 = 4,
  kInt64 = 5,
  kUint16 = 6,
  kUint32 = 7,
  kUint64 = 8,
  kFloat32 = 9,
  kFloat64 = 10,
  kChar8 = 16
};

/// Bytes of a number in CDR; 0: not a number (a character), or a type that this project does not decode.
constexpr std::size_t size_of_number(std::uint8_t kind) {
  switch (kind) {
    case kBoolean:
    case kByte:
      return 1;
    case kInt16:
    case kUint16:
      return 2;
    case kInt32:
    case kUint32:
    case kFloat32:
      return 4;
    case kInt64:
    case kUint64:
    case kFloat64:
      return 8;
    default:
      return 0;
  }
}

}  // namespace constrictor::dds::primitives
