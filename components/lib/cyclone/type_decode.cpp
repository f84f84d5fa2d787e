// Decodes CDR by a described type. Source: OMG DDS-XTypes 1.3, section 7.4 (XCDR1 and XCDR2).
#include <bit>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "constrictor/text.hpp"
#include "cyclone/primitives.hpp"
#include "cyclone/sample_visitor.hpp"
#include "cyclone/type_node.hpp"

namespace constrictor::dds {
namespace {

using Kind = TypeNode::Kind;
using namespace primitives;

class Decoder {
 public:
  Decoder(std::span<const std::uint8_t> bytes, SampleVisitor& visitor) : visitor_(visitor) {
    if (bytes.size() < 4) damaged("no encapsulation header");
    const unsigned id = static_cast<unsigned>(bytes[0] << 8 | bytes[1]);
    if (id > 0x0b) damaged("unknown encapsulation");
    swap_ = ((id & 1) != 0) != (std::endian::native == std::endian::little);
    xcdr2_ = id >= 6;
    if (id == 2 || id == 3) damaged("parameter lists of XCDR1 are not decoded");
    bytes_ = bytes.subspan(4);
  }

  void value(const TypeNode& type) {
    switch (type.kind) {
      case Kind::kPrimitive:
      case Kind::kBitmask:
        return primitive(type.primitive);
      case Kind::kString:
        return visitor_.text(string());
      case Kind::kEnum:
        static_cast<void>(enumerator(type));
        return;
      case Kind::kSequence: {
        if (xcdr2_ && !type.element->is_primitive()) number<std::uint32_t>();
        const std::uint32_t count = number<std::uint32_t>();
        if (count > bytes_.size()) damaged("a sequence longer than its sample");
        return elements(*type.element, std::span(&count, 1));
      }
      case Kind::kArray:
        if (xcdr2_ && !type.element->is_primitive()) number<std::uint32_t>();
        return elements(*type.element, type.bounds);
      case Kind::kStruct:
        return structure(type);
      case Kind::kUnion:
        return choice(type);
    }
  }

 private:
  [[noreturn]] static void damaged(const char* what) { throw std::runtime_error(std::string("sample: ") + what); }

  void align(std::size_t size) {
    const std::size_t to = std::min<std::size_t>(size, xcdr2_ ? 4 : 8);
    at_ = (at_ + to - 1) / to * to;
  }
  void need(std::size_t size) const {
    if (at_ > bytes_.size() || size > bytes_.size() - at_) damaged("shorter than its type requires");
  }
  template <class T>
  T number() {
    align(sizeof(T));
    need(sizeof(T));
    std::array<std::uint8_t, sizeof(T)> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, raw.data(), sizeof(T));
    return value;
  }
  /// A value of the wire's type for T: a boolean is a byte.
  template <class T>
  T value_of() {
    if constexpr (std::is_same_v<T, bool>) return number<std::uint8_t>() != 0;
    else return number<T>();
  }
  void primitive(std::uint8_t kind) {
    if (kind == kChar8) return visitor_.text(std::string(1, static_cast<char>(number<std::uint8_t>())));
    with_number_type(
        kind,
        [this]<class T>(T) {
          if constexpr (std::is_same_v<T, bool>) visitor_.boolean(value_of<T>());
          else if constexpr (std::is_floating_point_v<T>) visitor_.real(static_cast<double>(value_of<T>()));
          else if constexpr (std::is_signed_v<T>) visitor_.whole(value_of<T>());
          else visitor_.natural(value_of<T>());
        },
        [] { damaged("a primitive type that is not decoded"); });
  }
  std::int64_t whole_number(std::uint8_t kind) {
    if (kind == kChar8) return number<std::uint8_t>();
    const auto refuse = []() -> std::int64_t { damaged("an enumeration or union of a type that is not decoded"); };
    return with_number_type(
        kind,
        [this, refuse]<class T>(T) {
          if constexpr (std::is_integral_v<T>) return static_cast<std::int64_t>(value_of<T>());
          else return refuse();
        },
        refuse);
  }
  std::int64_t enumerator(const TypeNode& type) {
    const std::int64_t number = whole_number(type.primitive);
    const auto literal = type.literals.find(number);
    if (literal == type.literals.end()) visitor_.whole(number);
    else visitor_.text(literal->second);
    return number;
  }
  std::string string() {
    const std::uint32_t length = number<std::uint32_t>();
    need(length);
    if (length == 0) return "";  // some vendors omit the terminating zero of an empty string
    std::string text(reinterpret_cast<const char*>(bytes_.data() + at_), length - 1);
    at_ += length;
    return printable(std::move(text));
  }
  void elements(const TypeNode& type, std::span<const std::uint32_t> dimensions) {
    const std::size_t size = type.is_primitive() ? size_of_number(type.primitive) : 0;
    if (size > 0) return numbers(type.primitive, size, dimensions);
    visitor_.begin_list(dimensions.front());
    for (std::uint32_t i = 0; i < dimensions.front(); ++i) {
      if (dimensions.size() == 1) value(type);
      else elements(type, dimensions.subspan(1));
    }
    visitor_.end_list();
  }
  void numbers(std::uint8_t kind, std::size_t size, std::span<const std::uint32_t> dimensions) {
    std::size_t count = 1;
    for (const std::uint32_t dimension : dimensions) {
      count *= dimension;
      if (count > bytes_.size()) damaged("shorter than its type requires");
    }
    if (count > 0) align(size);
    need(count * size);
    std::span<const std::uint8_t> bytes = bytes_.subspan(at_, count * size);
    if ((swap_ && size > 1) || kind == kBoolean) {
      scratch_.assign(bytes.begin(), bytes.end());
      for (std::size_t i = 0; kind == kBoolean && i < scratch_.size(); ++i) scratch_[i] = scratch_[i] != 0;
      for (auto at = scratch_.begin(); swap_ && at != scratch_.end(); at += static_cast<std::ptrdiff_t>(size))
        std::reverse(at, at + static_cast<std::ptrdiff_t>(size));
      bytes = scratch_;
    }
    at_ += count * size;
    visitor_.numbers({kind, dimensions, bytes});
  }
  /// Position after the value, from its delimiter header; without such a header, the end of the sample.
  std::size_t delimited(const TypeNode& type) {
    if (!xcdr2_ || type.extensibility == TypeNode::Extensibility::kFinal) return bytes_.size();
    const std::uint32_t size = number<std::uint32_t>();
    need(size);
    return at_ + size;
  }
  void structure(const TypeNode& type) {
    visitor_.begin_struct(type);
    const bool framed = xcdr2_ && type.extensibility != TypeNode::Extensibility::kFinal;
    const std::size_t end = delimited(type);
    if (type.extensibility == TypeNode::Extensibility::kMutable) {
      if (!xcdr2_) damaged("mutable types in XCDR1 are not decoded");
      mutable_members(type, end);
    } else {
      for (const auto& member : type.members) {
        if (framed && at_ >= end) break;  // the writer has an older version of the type
        visitor_.member(member.name);
        if (member.optional && number<std::uint8_t>() == 0) visitor_.absent();
        else value(*member.type);
      }
    }
    if (framed) at_ = end;
    visitor_.end_struct();
  }
  void mutable_members(const TypeNode& type, std::size_t end) {
    constexpr std::uint32_t kSizes[] = {1, 2, 4, 8};
    while (at_ + 4 <= end) {
      const std::uint32_t header = number<std::uint32_t>();
      const std::uint32_t code = header >> 28 & 7;
      std::size_t size = code < 4 ? kSizes[code] : number<std::uint32_t>();
      if (code > 4) {  // the length is also the first field of the member itself
        at_ -= 4;
        size = 4 + size * (code == 5 ? 1 : code == 6 ? 4 : 8);
      }
      const std::size_t next = at_ + size;
      need(size);
      for (const auto& member : type.members) {
        if (member.id != (header & 0x0fffffff)) continue;
        visitor_.member(member.name);
        value(*member.type);
      }
      at_ = next;
    }
  }
  void choice(const TypeNode& type) {
    visitor_.begin_struct(type);
    const bool framed = xcdr2_ && type.extensibility != TypeNode::Extensibility::kFinal;
    const std::size_t end = delimited(type);
    visitor_.member("_d");
    const std::int64_t label = discriminator(*type.element);
    const TypeNode::Member* chosen = nullptr;
    for (const auto& member : type.members) {
      if (member.is_default && !chosen) chosen = &member;
      if (std::count(member.labels.begin(), member.labels.end(), label) > 0) {
        chosen = &member;
        break;
      }
    }
    if (chosen) {
      visitor_.member(chosen->name);
      value(*chosen->type);
    }
    if (framed) at_ = end;
    visitor_.end_struct();
  }
  std::int64_t discriminator(const TypeNode& type) {
    if (type.kind == Kind::kEnum) return enumerator(type);
    const std::int64_t label = whole_number(type.primitive);
    if (type.primitive == kBoolean) visitor_.boolean(label != 0);
    else if (type.primitive == kChar8) visitor_.text(std::string(1, static_cast<char>(label)));
    else visitor_.whole(label);
    return label;
  }

  SampleVisitor& visitor_;
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool swap_ = false;
  bool xcdr2_ = false;
  std::vector<std::uint8_t> scratch_;  ///< numbers in the byte order of this machine
};

}  // namespace

void decode(const TypeNode& type, std::span<const std::uint8_t> bytes, SampleVisitor& visitor) {
  Decoder(bytes, visitor).value(type);
}

}  // namespace constrictor::dds
