// Decoded samples as JSON.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <utility>
#include <vector>

#include "cyclone/primitives.hpp"
#include "cyclone/sample_visitor.hpp"
#include "cyclone/type_node.hpp"
#include "cyclone/type_tree.hpp"

namespace constrictor::dds {
namespace {

using Json = nlohmann::ordered_json;
using namespace primitives;

/// Builds JSON. NaN and infinities become null.
class JsonBuilder : public SampleVisitor {
 public:
  [[nodiscard]] Json take() { return std::move(root_); }

  void boolean(bool value) override { place() = value; }
  void whole(std::int64_t value) override { place() = value; }
  void natural(std::uint64_t value) override { place() = value; }
  void real(double value) override { place() = real_json(value); }
  void text(std::string value) override { place() = std::move(value); }
  void absent() override { place() = nullptr; }
  void numbers(const NumberArray& values) override {
    const std::uint8_t* at = values.bytes.data();
    place() = list(values.primitive, values.dimensions, at);
  }
  void begin_list(std::uint32_t) override { open(Json::array()); }
  void end_list() override { open_.pop_back(); }
  void begin_struct(const TypeNode&) override { open(Json::object()); }
  void member(const std::string& name) override { member_ = name; }
  void end_struct() override { open_.pop_back(); }

 private:
  static Json real_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }
  Json& place() {
    if (open_.empty()) return root_;
    Json& parent = *open_.back();
    return parent.is_object() ? parent[member_] : parent.emplace_back();
  }
  void open(Json empty) {
    Json& made = place();
    made = std::move(empty);
    open_.push_back(&made);
  }
  template <class T>
  static T next(const std::uint8_t*& at) {
    T value;
    std::memcpy(&value, at, sizeof(T));
    at += sizeof(T);
    return value;
  }
  static Json one(std::uint8_t kind, const std::uint8_t*& at) {
    return with_number_type(
        kind,
        [&at]<class T>(T) {
          if constexpr (std::is_same_v<T, bool>) return Json(next<std::uint8_t>(at) != 0);
          else if constexpr (std::is_floating_point_v<T>) return real_json(static_cast<double>(next<T>(at)));
          else return Json(next<T>(at));
        },
        [] { return Json(); });
  }
  static Json list(std::uint8_t kind, std::span<const std::uint32_t> dimensions, const std::uint8_t*& at) {
    Json made = Json::array();
    for (std::uint32_t i = 0; i < dimensions.front(); ++i)
      made.push_back(dimensions.size() == 1 ? one(kind, at) : list(kind, dimensions.subspan(1), at));
    return made;
  }

  Json root_;
  std::vector<Json*> open_;  ///< a list grows only after the values in it are complete, so the pointers stay valid
  std::string member_;
};

}  // namespace

Json decode(const TypeNode& type, std::span<const std::uint8_t> bytes) {
  JsonBuilder builder;
  decode(type, bytes, builder);
  return builder.take();
}

Json TypeTree::decode(std::span<const std::uint8_t> bytes) const { return dds::decode(*root_, bytes); }
void TypeTree::decode(std::span<const std::uint8_t> bytes, SampleVisitor& visitor) const {
  dds::decode(*root_, bytes, visitor);
}

}  // namespace constrictor::dds
