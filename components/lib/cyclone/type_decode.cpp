// Decodes CDR by a described type. Source: OMG DDS-XTypes 1.3, section 7.4 (XCDR1 and XCDR2).
#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "constrictor/text.hpp"
#include "cyclone/type_node.hpp"
#include "cyclone/type_tree.hpp"

namespace constrictor::dds {
namespace {

using Json = nlohmann::ordered_json;
using Kind = TypeNode::Kind;

// DDS_XTypes_TK_...
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

class Decoder {
 public:
  explicit Decoder(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 4) damaged("no encapsulation header");
    const unsigned id = static_cast<unsigned>(bytes[0] << 8 | bytes[1]);
    if (id > 0x0b) damaged("unknown encapsulation");
    swap_ = ((id & 1) != 0) != (std::endian::native == std::endian::little);
    xcdr2_ = id >= 6;
    if (id == 2 || id == 3) damaged("parameter lists of XCDR1 are not decoded");
    bytes_ = bytes.subspan(4);
  }

  Json value(const TypeNode& type) {
    switch (type.kind) {
      case Kind::kPrimitive:
        return primitive(type.primitive);
      case Kind::kString:
        return string();
      case Kind::kEnum: {
        const std::int64_t number = primitive(type.primitive).get<std::int64_t>();
        const auto literal = type.literals.find(number);
        return literal == type.literals.end() ? Json(number) : Json(literal->second);
      }
      case Kind::kBitmask:
        return primitive(type.primitive);
      case Kind::kSequence: {
        if (xcdr2_ && !type.element->is_primitive()) number<std::uint32_t>();
        return elements(*type.element, number<std::uint32_t>());
      }
      case Kind::kArray: {
        if (xcdr2_ && !type.element->is_primitive()) number<std::uint32_t>();
        return array(type, 0);
      }
      case Kind::kStruct:
        return structure(type);
      case Kind::kUnion:
        return choice(type);
    }
    return nullptr;
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
  template <class T>
  Json real() {
    const T value = number<T>();
    return std::isfinite(value) ? Json(value) : Json(nullptr);
  }
  Json primitive(std::uint8_t kind) {
    switch (kind) {
      case kBoolean:
        return number<std::uint8_t>() != 0;
      case kByte:
        return number<std::uint8_t>();
      case kInt16:
        return number<std::int16_t>();
      case kInt32:
        return number<std::int32_t>();
      case kInt64:
        return number<std::int64_t>();
      case kUint16:
        return number<std::uint16_t>();
      case kUint32:
        return number<std::uint32_t>();
      case kUint64:
        return number<std::uint64_t>();
      case kFloat32:
        return real<float>();
      case kFloat64:
        return real<double>();
      case kChar8:
        return std::string(1, static_cast<char>(number<std::uint8_t>()));
      default:
        damaged("a primitive type that is not decoded");
    }
  }
  Json string() {
    const std::uint32_t length = number<std::uint32_t>();
    need(length);
    if (length == 0) return "";  // some vendors omit the terminating zero of an empty string
    std::string text(reinterpret_cast<const char*>(bytes_.data() + at_), length - 1);
    at_ += length;
    return printable(std::move(text));
  }
  Json elements(const TypeNode& type, std::uint32_t count) {
    if (count > bytes_.size()) damaged("a sequence longer than its sample");
    Json list = Json::array();
    for (std::uint32_t i = 0; i < count; ++i) list.push_back(value(type));
    return list;
  }
  Json array(const TypeNode& type, std::size_t dimension) {
    if (dimension + 1 == type.bounds.size()) return elements(*type.element, type.bounds[dimension]);
    Json list = Json::array();
    for (std::uint32_t i = 0; i < type.bounds[dimension]; ++i) list.push_back(array(type, dimension + 1));
    return list;
  }
  /// Position after the value, from its delimiter header; without such a header, the end of the sample.
  std::size_t delimited(const TypeNode& type) {
    if (!xcdr2_ || type.extensibility == TypeNode::Extensibility::kFinal) return bytes_.size();
    const std::uint32_t size = number<std::uint32_t>();
    need(size);
    return at_ + size;
  }
  Json structure(const TypeNode& type) {
    Json object = Json::object();
    const bool framed = xcdr2_ && type.extensibility != TypeNode::Extensibility::kFinal;
    const std::size_t end = delimited(type);
    if (type.extensibility == TypeNode::Extensibility::kMutable) {
      if (!xcdr2_) damaged("mutable types in XCDR1 are not decoded");
      mutable_members(type, end, object);
    } else {
      for (const auto& member : type.members) {
        if (framed && at_ >= end) break;  // the writer has an older version of the type
        if (member.optional && number<std::uint8_t>() == 0) object[member.name] = nullptr;
        else object[member.name] = value(*member.type);
      }
    }
    if (framed) at_ = end;
    return object;
  }
  void mutable_members(const TypeNode& type, std::size_t end, Json& object) {
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
        if (member.id == (header & 0x0fffffff)) object[member.name] = value(*member.type);
      }
      at_ = next;
    }
  }
  Json choice(const TypeNode& type) {
    const bool framed = xcdr2_ && type.extensibility != TypeNode::Extensibility::kFinal;
    const std::size_t end = delimited(type);
    const Json shown = value(*type.element);
    std::int64_t label = 0;
    if (shown.is_string()) {
      for (const auto& [number, name] : type.element->literals) {
        if (name == shown.get<std::string>()) label = number;
      }
    } else {
      label = shown.is_boolean() ? shown.get<bool>() : shown.get<std::int64_t>();
    }
    const TypeNode::Member* chosen = nullptr;
    for (const auto& member : type.members) {
      if (member.is_default && !chosen) chosen = &member;
      if (std::count(member.labels.begin(), member.labels.end(), label) > 0) {
        chosen = &member;
        break;
      }
    }
    Json object = Json::object();
    object["_d"] = shown;
    if (chosen) object[chosen->name] = value(*chosen->type);
    if (framed) at_ = end;
    return object;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool swap_ = false;
  bool xcdr2_ = false;
};

}  // namespace

Json decode(const TypeNode& type, std::span<const std::uint8_t> bytes) { return Decoder(bytes).value(type); }

Json TypeTree::decode(std::span<const std::uint8_t> bytes) const { return dds::decode(*root_, bytes); }

}  // namespace constrictor::dds
