// Fields of a report.json that is not trusted: what is missing or of a wrong type is unknown.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>

namespace constrictor::cli {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// The value with this key; null if there is none, or if `object` is no object.
[[nodiscard]] inline const nlohmann::json& field(const nlohmann::json& object, const char* key) {
  static const nlohmann::json kNothing;
  if (!object.is_object()) return kNothing;
  const auto found = object.find(key);
  return found == object.end() ? kNothing : *found;
}

[[nodiscard]] inline double number_field(const nlohmann::json& object, const char* key) {
  const nlohmann::json& value = field(object, key);
  return value.is_number() ? value.get<double>() : kUnknown;
}

[[nodiscard]] inline bool flag_field(const nlohmann::json& object, const char* key) {
  const nlohmann::json& value = field(object, key);
  return value.is_boolean() && value.get<bool>();
}

[[nodiscard]] inline std::string text_field(const nlohmann::json& object, const char* key) {
  const nlohmann::json& value = field(object, key);
  return value.is_string() ? value.get<std::string>() : std::string();
}

/// A count of at most a million; 0 if it is unknown.
[[nodiscard]] inline int count_field(const nlohmann::json& object, const char* key) {
  const double value = number_field(object, key);
  return value >= 0 && value < 1e6 ? static_cast<int>(value) : 0;
}

}  // namespace constrictor::cli
