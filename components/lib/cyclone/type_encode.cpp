// Encodes JSON to CDR (XCDR1, little-endian) by a described type.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "configuration/closest_name.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/field_table.hpp"
#include "constrictor/json.hpp"
#include "constrictor/reflect.hpp"
#include "cyclone/primitives.hpp"
#include "cyclone/type_node.hpp"
#include "cyclone/type_tree.hpp"

namespace constrictor::dds {
namespace {

using Json = nlohmann::ordered_json;
using Kind = TypeNode::Kind;
using namespace primitives;
static_assert(std::endian::native == std::endian::little, "the encoder writes numbers as they are in memory");

std::string shown(const Json& value) {
  const std::string text = json_text(value);
  return text.size() > 40 ? text.substr(0, 40) + "..." : text;
}

class Encoder {
 public:
  /// `value`: null stands for a value that was left out, where `given` is false.
  void encode(const TypeNode& type, const Json& value, bool given, const FieldEntry* field, const std::string& path) {
    switch (type.kind) {
      case Kind::kPrimitive:
      case Kind::kBitmask:
        return primitive(type.primitive, value, given, field, path);
      case Kind::kEnum:
        return enumeration(type, value, given, path);
      case Kind::kString:
        if (given && !value.is_string()) wrong(path, value, "a text");
        return text(given ? value.get<std::string>() : "", type.most, path);
      case Kind::kSequence:
        return sequence(type, value, given, path);
      case Kind::kArray:
        return array(type, 0, value, given, field, path);
      case Kind::kStruct:
        return structure(type, value, given, path);
      case Kind::kUnion:
        break;
    }
    throw std::invalid_argument(named(path) + ": a union cannot be written");
  }
  /// The bytes, padded to a multiple of 4 as Cyclone does; the header says by how many.
  [[nodiscard]] std::vector<std::uint8_t> take() {
    const auto padding = static_cast<std::uint8_t>((4 - bytes_.size() % 4) % 4);
    bytes_.insert(bytes_.end(), padding, 0);
    bytes_[3] = padding;
    return std::move(bytes_);
  }

 private:
  static std::string named(const std::string& path) { return path.empty() ? "message" : path; }
  [[noreturn]] static void wrong(const std::string& path, const std::string& found, const std::string& accepted) {
    throw std::invalid_argument(named(path) + ": found " + found + ", accepted " + accepted);
  }
  [[noreturn]] static void wrong(const std::string& path, const Json& found, const std::string& accepted) {
    wrong(path, shown(found), accepted);
  }

  template <class T>
  void put(T value) {
    // The position counts from the end of the encapsulation header, which has 4 bytes.
    while ((bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    const auto* raw = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), raw, raw + sizeof(T));
  }

  template <class T>
  void whole(const Json& value, bool given, const FieldEntry* field, const std::string& path) {
    using Limits = std::numeric_limits<T>;
    const double least =
        std::max(field && field->info.has_range ? field->info.min : -INFINITY, static_cast<double>(Limits::min()));
    const double most =
        std::min(field && field->info.has_range ? field->info.max : INFINITY, static_cast<double>(Limits::max()));
    const ConstantGroup* group = field ? field->info.constants : nullptr;
    const auto accepted = [&] {
      if (!group) return fmt::format("a whole number from {:.0f} to {:.0f}", least, most);
      auto names = names_of(*group, static_cast<std::uint8_t>(least));
      names.resize(std::min(names.size(), static_cast<std::size_t>(most - least) + 1));
      return fmt::format("{}{}", fmt::join(names, ", "),
                         value.is_string() ? did_you_mean(value.get<std::string>(), names) : "");
    };
    if (!given) {
      if (least > 0.0) wrong(path, std::string("nothing"), accepted());
      return put<T>(0);
    }
    if (group && value.is_string()) {
      const auto constant = value_of(*group, value.get<std::string>());
      if (!constant || *constant < least || *constant > most) wrong(path, value, accepted());
      return put(static_cast<T>(*constant));
    }
    const bool integral = value.is_number_integer() ||
                          (value.is_number_float() && value.get<double>() == std::trunc(value.get<double>()));
    if (!integral) wrong(path, value, accepted());
    const bool fits =
        value.is_number_unsigned() ? std::in_range<T>(value.get<std::uint64_t>())
        : value.is_number_integer()
            ? std::in_range<T>(value.get<std::int64_t>())
            : std::abs(value.get<double>()) < 9e15 && std::in_range<T>(static_cast<std::int64_t>(value.get<double>()));
    if (!fits || value.get<double>() < least || value.get<double>() > most) wrong(path, value, accepted());
    put(value.get<T>());
  }

  template <class T>
  void real(const Json& value, bool given, const FieldEntry* field, const std::string& path) {
    double number = given ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    if (given && value.is_number()) number = value.get<double>();
    else if (given && !value.is_null()) wrong(path, value, "a number, or null for NaN");
    if (field && !reflect::acceptable(field->info, number)) {
      const bool range = field->info.has_range;
      wrong(path, given ? shown(value) : "nothing",
            (range ? fmt::format("a number from {:g} to {:g}", field->info.min, field->info.max)
                   : std::string("a finite number")) +
                (field->info.nan_allowed ? ", or null for NaN" : ""));
    }
    put(static_cast<T>(number));
  }

  void primitive(std::uint8_t kind, const Json& value, bool given, const FieldEntry* field, const std::string& path) {
    if (kind == kChar8) {
      if (given && (!value.is_string() || value.get_ref<const std::string&>().size() != 1))
        wrong(path, value, "a text of one character");
      return put<char>(given ? value.get_ref<const std::string&>().front() : '\0');
    }
    with_number_type(
        kind,
        [&]<class T>(T) {
          if constexpr (std::is_same_v<T, bool>) {
            if (given && !value.is_boolean()) wrong(path, value, "true or false");
            put<std::uint8_t>(given && value.get<bool>() ? 1 : 0);
          } else if constexpr (std::is_floating_point_v<T>) {
            real<T>(value, given, field, path);
          } else {
            whole<T>(value, given, field, path);
          }
        },
        [&] { throw std::invalid_argument(named(path) + ": its type cannot be written"); });
  }

  void enumeration(const TypeNode& type, const Json& value, bool given, const std::string& path) {
    if (!given && !type.literals.empty())
      return primitive(type.primitive, Json(type.literals.begin()->first), true, nullptr, path);
    std::vector<std::string> names;
    for (const auto& [number, name] : type.literals) {
      if (value == Json(name) || value == Json(number)) return primitive(type.primitive, number, true, nullptr, path);
      names.push_back(name);
    }
    wrong(path, value,
          fmt::format("{}{}", fmt::join(names, ", "),
                      value.is_string() ? did_you_mean(value.get<std::string>(), names) : ""));
  }

  void text(const std::string& text, std::uint32_t most, const std::string& path) {
    if (most > 0 && text.size() > most) wrong(path, Json(text), "a text of at most " + std::to_string(most) + " bytes");
    if (text.find('\0') != std::string::npos) wrong(path, Json(text), "a text without zero bytes");
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_.insert(bytes_.end(), text.begin(), text.end());
    bytes_.push_back(0);
  }

  void sequence(const TypeNode& type, const Json& value, bool given, const std::string& path) {
    const bool octets = given && value.is_binary() && type.element->is_primitive() && type.element->primitive == kByte;
    if (given && !octets && !value.is_array()) wrong(path, value, "a list");
    const std::size_t count = !given ? 0 : octets ? value.get_binary().size() : value.size();
    if (type.most > 0 && count > type.most)
      wrong(path, Json(count), "at most " + std::to_string(type.most) + " elements");
    put(static_cast<std::uint32_t>(count));
    if (octets) bytes_.insert(bytes_.end(), value.get_binary().begin(), value.get_binary().end());
    else elements(*type.element, value, count, count, nullptr, path);
  }

  void array(const TypeNode& type, std::size_t dimension, const Json& value, bool given, const FieldEntry* field,
             const std::string& path) {
    const std::size_t length = type.bounds[dimension];
    const bool may_be_shorter = field && field->count_at >= 0;
    if (given && (!value.is_array() || value.size() > length || (value.size() < length && !may_be_shorter)))
      wrong(path, value, std::string("a list of ") + (may_be_shorter ? "at most " : "") + std::to_string(length));
    const std::size_t count = given ? value.size() : 0;
    if (dimension + 1 == type.bounds.size()) return elements(*type.element, value, count, length, field, path);
    for (std::size_t i = 0; i < length; ++i)
      array(type, dimension + 1, given ? value[i] : Json(), given, nullptr, path + "[" + std::to_string(i) + "]");
  }

  /// `length` values of which the list gives the first `count`. The limits of a field are for the values that are
  /// given.
  void elements(const TypeNode& type, const Json& list, std::size_t count, std::size_t length, const FieldEntry* field,
                const std::string& path) {
    for (std::size_t i = 0; i < length; ++i) {
      const bool given = i < count;
      encode(type, given ? list[i] : Json(), given, given ? field : nullptr, path + "[" + std::to_string(i) + "]");
    }
  }

  void structure(const TypeNode& type, const Json& value, bool given, const std::string& path) {
    if (given && !value.is_object()) wrong(path, value, "an object with fields");
    if (type.extensibility == TypeNode::Extensibility::kMutable)
      throw std::invalid_argument(named(path) + ": a mutable type cannot be written");
    if (given) check_names(type, value, path);
    // An element beyond the given ones is zero, whatever the limits of its fields are.
    const bool beyond = !given && !path.empty();
    const auto* fields = beyond ? nullptr : fields_of(type.name);
    for (std::size_t i = 0; i < type.members.size(); ++i) {
      const auto& member = type.members[i];
      if (member.optional) throw std::invalid_argument(named(path) + ": an optional field cannot be written");
      const FieldEntry* field = fields && i < fields->size() ? &(*fields)[i] : nullptr;
      const std::string at = path.empty() ? member.name : path + "." + member.name;
      const bool has = given && value.contains(member.name);
      if (has) encode(*member.type, value[member.name], true, field, at);
      else if (const auto count = counted(fields, i, given ? value : Json()))
        encode(*member.type, Json(*count), true, field, at);
      else encode(*member.type, Json(), false, field, at);
    }
  }

  static void check_names(const TypeNode& type, const Json& value, const std::string& path) {
    for (const auto& [name, ignored] : value.items()) {
      std::vector<std::string> names;
      for (const auto& member : type.members) names.push_back(member.name);
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw std::invalid_argument(fmt::format("{}: there is no field '{}'; accepted are {}{}", named(path), name,
                                                fmt::join(names, ", "), did_you_mean(name, names)));
    }
  }

  /// The length of the longest list that field `i` counts; empty if it counts none that is given.
  static std::optional<std::size_t> counted(const std::vector<FieldEntry>* fields, std::size_t i, const Json& value) {
    std::optional<std::size_t> count;
    if (!fields) return count;
    for (const FieldEntry& field : *fields) {
      if (field.count_at != static_cast<std::ptrdiff_t>(i) || !value.is_object()) continue;
      const auto list = value.find(field.info.name);
      if (list != value.end() && list->is_array()) count = std::max(count.value_or(0), list->size());
    }
    return count;
  }

  std::vector<std::uint8_t> bytes_{0, 1, 0, 0};  // the header: CDR, little-endian
};

}  // namespace

std::vector<std::uint8_t> encode(const TypeNode& type, const Json& value) {
  Encoder encoder;
  encoder.encode(type, value, true, nullptr, "");
  return encoder.take();
}

std::vector<std::uint8_t> TypeTree::encode(const Json& value) const { return dds::encode(*root_, value); }

}  // namespace constrictor::dds
