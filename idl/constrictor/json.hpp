// Messages as JSON, for people and tools. Include it in .cpp files only, because the JSON library compiles slowly.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "constrictor/reflect.hpp"

namespace constrictor {

/// JSON as text. Bytes of a message that are not UTF-8 become U+FFFD; dump() alone would throw an exception.
template <class Json>
std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

namespace reflect {

struct JsonWriter {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();

  template <class T>
  static nlohmann::ordered_json value_of(const T& value) {
    if constexpr (Described<T>) {
      JsonWriter inner;
      Description<T>::visit(value, inner);
      return std::move(inner.json);
    } else {
      // JSON has neither NaN nor infinity: such numbers become null.
      if constexpr (std::is_floating_point_v<T>) {
        if (!std::isfinite(value)) return nullptr;
      }
      return value;
    }
  }
  template <class T>
  void operator()(const FieldInfo& info, const T& value) {
    json[info.name] = value_of(value);
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&values)[N]) {
    auto& array = json[info.name] = nlohmann::ordered_json::array();
    for (const T& value : values) array.push_back(value_of(value));
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, const char (&text)[N]) {
    json[info.name] = std::string(text, ::strnlen(text, N));
  }
  void operator()(const FieldInfo& info, const dds_sequence_octet& octets) {
    json[info.name] = "<" + std::to_string(octets._length) + " bytes>";
  }
};

}  // namespace reflect

/// All fields in order. Arrays are complete; of a sequence of bytes only the length is written.
template <Described T>
[[nodiscard]] nlohmann::ordered_json to_json(const T& message) {
  return reflect::JsonWriter::value_of(message);
}

}  // namespace constrictor
