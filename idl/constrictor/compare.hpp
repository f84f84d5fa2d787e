// The first difference between two messages of one type.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <optional>
#include <string>

#include "constrictor/reflect.hpp"

namespace constrictor {

/// The first field, in the order of the IDL, whose bits differ.
struct FieldDifference {
  std::string path;  ///< e.g. "module_poses[3].position_m.x"
  std::string a;     ///< values as text; floating-point numbers with all their digits
  std::string b;
};

namespace reflect {

inline std::string join_path(const std::string& prefix, const std::string& name) {
  return prefix.empty() ? name : prefix + "." + name;
}

template <class T>
std::string value_text(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.17g", static_cast<double>(value));
    return text;
  } else {
    return std::to_string(value);
  }
}

/// Unlike ==, this tells 0.0 from -0.0 and takes a NaN for equal to itself. T: a number, or an array of numbers.
template <class T>
bool same_bytes(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;  // NOLINT(bugprone-suspicious-memory-comparison)
}

/// Visits the fields of `a` and finds the same field of `b` at the same offset.
template <class Message>
struct Comparer {
  const Message& a;
  const Message& b;
  std::string prefix;
  std::optional<FieldDifference> found;

  template <class T>
  const T& twin(const T& field) const {
    const auto offset = reinterpret_cast<const char*>(&field) - reinterpret_cast<const char*>(&a);
    return *reinterpret_cast<const T*>(reinterpret_cast<const char*>(&b) + offset);
  }
  template <class T>
  void compare(const std::string& path, const T& left, const T& right) {
    if (found) return;
    if constexpr (Described<T>) {
      Comparer<T> inner{left, right, path, {}};
      Description<T>::visit(left, inner);
      found = std::move(inner.found);
    } else if (!same_bytes(left, right)) {
      found = FieldDifference{path, value_text(left), value_text(right)};
    }
  }
  template <class T>
  void operator()(const FieldInfo& info, const T& value) {
    if (!found) compare(join_path(prefix, info.name), value, twin(value));
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&values)[N]) {
    if (found) return;
    if constexpr (!Described<T>) {
      if (same_bytes(values, twin(values))) return;
    }
    for (std::size_t i = 0; i < N && !found; ++i) {
      compare(join_path(prefix, info.name) + "[" + std::to_string(i) + "]", values[i], twin(values[i]));
    }
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, const char (&text)[N]) {
    const std::string left(text, ::strnlen(text, N));
    const std::string right(twin(text), ::strnlen(twin(text), N));
    if (!found && left != right)
      found = FieldDifference{join_path(prefix, info.name), "'" + left + "'", "'" + right + "'"};
  }
  void operator()(const FieldInfo& info, const dds_sequence_octet& left) {
    const dds_sequence_octet& right = twin(left);
    const std::string path = join_path(prefix, info.name);
    if (found) return;
    for (std::uint32_t i = 0; i < std::min(left._length, right._length); ++i) {
      if (left._buffer[i] == right._buffer[i]) continue;
      found = FieldDifference{path + "[" + std::to_string(i) + "]", std::to_string(left._buffer[i]),
                              std::to_string(right._buffer[i])};
      return;
    }
    if (left._length != right._length) {
      found = FieldDifference{path, std::to_string(left._length) + " bytes", std::to_string(right._length) + " bytes"};
    }
  }
};

}  // namespace reflect

/// Empty if the messages are equal bit for bit: -0.0 differs from 0.0, and a NaN equals itself.
template <Described T>
[[nodiscard]] std::optional<FieldDifference> first_difference(const T& a, const T& b) {
  reflect::Comparer<T> comparer{a, b, {}, {}};
  Description<T>::visit(a, comparer);
  return std::move(comparer.found);
}

}  // namespace constrictor
