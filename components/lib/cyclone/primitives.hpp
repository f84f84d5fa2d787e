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

/// Calls `visit` with a zero of the C++ type of a number, which is bool for a boolean, and returns its result. Calls
/// `otherwise` for what is not a number (a character), and for types that this project does not decode.
template <class Visit, class Otherwise>
constexpr auto with_number_type(std::uint8_t kind, Visit&& visit, Otherwise&& otherwise) {
  switch (kind) {
    case kBoolean:
      return visit(false);
    case kByte:
      return visit(std::uint8_t{});
    case kInt16:
      return visit(std::int16_t{});
    case kInt32:
      return visit(std::int32_t{});
    case kInt64:
      return visit(std::int64_t{});
    case kUint16:
      return visit(std::uint16_t{});
    case kUint32:
      return visit(std::uint32_t{});
    case kUint64:
      return visit(std::uint64_t{});
    case kFloat32:
      return visit(float{});
    case kFloat64:
      return visit(double{});
    default:
      return otherwise();
  }
}

/// Bytes of a number in CDR; 0: not a number.
constexpr std::size_t size_of_number(std::uint8_t kind) {
  static_assert(sizeof(bool) == 1, "the size of a boolean in CDR");
  return with_number_type(
      kind, [](auto zero) { return sizeof zero; }, [] { return std::size_t{0}; });
}

}  // namespace constrictor::dds::primitives
