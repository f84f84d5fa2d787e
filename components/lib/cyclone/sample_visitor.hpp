// Receives the values of a sample one after the other, so that each user builds its own objects from them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "cyclone/type_node.hpp"

namespace constrictor::dds {

/// Numbers of one primitive type, in the byte order of this machine; booleans are 0 or 1.
struct NumberArray {
  std::uint8_t primitive = 0;                 ///< DDS_XTypes_TK_...
  std::span<const std::uint32_t> dimensions;  ///< of the array or, with one element, of the sequence
  std::span<const std::uint8_t> bytes;
};

class SampleVisitor {
 public:
  virtual ~SampleVisitor() = default;
  virtual void boolean(bool value) = 0;
  virtual void whole(std::int64_t value) = 0;
  virtual void natural(std::uint64_t value) = 0;
  virtual void real(double value) = 0;  ///< may be NaN or infinite
  virtual void text(std::string value) = 0;
  virtual void absent() = 0;  ///< an optional member without a value
  /// An array or sequence of numbers; arrays of characters come as lists of texts.
  virtual void numbers(const NumberArray& values) = 0;
  /// A list of anything else, of `count` values.
  virtual void begin_list(std::uint32_t count) = 0;
  virtual void end_list() = 0;
  /// A structure or union begins; member() names the member to which the next value belongs.
  virtual void begin_struct(const TypeNode& type) = 0;
  virtual void member(const std::string& name) = 0;
  virtual void end_struct() = 0;
};

/// Decodes one sample. Throws std::runtime_error if the bytes are not one sample of `type`; some values may then have
/// been passed on.
void decode(const TypeNode& type, std::span<const std::uint8_t> bytes, SampleVisitor& visitor);

}  // namespace constrictor::dds
