// Functions that work on any message by its description: validation, deterministic bytes, deep copies.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

template <class T>
concept Described = requires {
  Description<std::remove_const_t<T>>::kName;
};

namespace reflect {

template <class T>
inline constexpr bool is_octets = std::is_same_v<std::remove_cv_t<T>, dds_sequence_octet>;

/// Text of a violated bound: "position_rad[3]: found nan, accepted finite".
std::string violation(const FieldInfo& info, std::ptrdiff_t index, double found);
std::string violation(const FieldInfo& info, const char* found_and_accepted);

/// Whether a number is within the limits that the IDL states for its field.
template <class T>
bool acceptable(const FieldInfo& info, T value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isnan(value)) return info.nan_allowed;
    if (std::isinf(value)) return false;
  }
  return !info.has_range || (static_cast<double>(value) >= info.min && static_cast<double>(value) <= info.max);
}

struct Validator {
  std::optional<std::string> found;
  template <class T>
  void check(const FieldInfo& info, const T& value, std::ptrdiff_t index) {
    if (found) return;
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
      if (found) *found = std::string(info.name) + (index < 0 ? "" : "[" + std::to_string(index) + "]") + "." + *found;
    } else if constexpr (!std::is_same_v<T, bool>) {
      if (!acceptable(info, value)) found = violation(info, index, static_cast<double>(value));
    } else {
      // Reading a bool whose byte is neither 0 nor 1 is undefined, so the byte itself is checked.
      if (*reinterpret_cast<const unsigned char*>(&value) > 1)
        found = violation(info, "found neither 0 nor 1, accepted a boolean");
    }
  }
  template <class T>
  void operator()(const FieldInfo& info, const T& value) {
    check(info, value, -1);
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&values)[N]) {
    for (std::size_t i = 0; i < N && !found; ++i) check(info, values[i], static_cast<std::ptrdiff_t>(i));
  }
  template <std::size_t N>
  void operator()(const FieldInfo& info, const char (&text)[N]) {
    if (!found && std::memchr(text, '\0', N) == nullptr)
      found = violation(info, "found text without an end, accepted a shorter one");
  }
  void operator()(const FieldInfo& info, const dds_sequence_octet& octets) {
    if (!found && octets._length > 0 && !octets._buffer)
      found = violation(info, "found a length without bytes, accepted bytes");
  }
};

/// Appends fields as raw little-endian bytes without padding; text and sequences with their length before them.
struct ByteWriter {
  std::string& bytes;
  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  template <class T>
  void operator()(const FieldInfo&, const T& value) {
    if constexpr (Described<T>) Description<T>::visit(value, *this);
    else raw(&value, sizeof(value));
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, const T (&values)[N]) {
    if constexpr (Described<T>) {
      for (const T& value : values) (*this)(info, value);
    } else {
      raw(values, sizeof(values));
    }
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, const char (&text)[N]) {
    const auto length = static_cast<std::uint16_t>(::strnlen(text, N));
    raw(&length, sizeof(length));
    raw(text, length);
  }
  void operator()(const FieldInfo&, const dds_sequence_octet& octets) {
    raw(&octets._length, sizeof(octets._length));
    raw(octets._buffer, octets._length);
  }
};

/// The inverse of ByteWriter. `ok` turns false on truncated input. Sequences end up in `octets`.
struct ByteReader {
  std::span<const std::byte> bytes;
  std::vector<std::uint8_t>& octets;
  bool ok = true;
  void raw(void* data, std::size_t size) {
    if (size > bytes.size()) {
      ok = false;
      return;
    }
    if (size > 0) std::memcpy(data, bytes.data(), size);  // memcpy requires non-null pointers even for size 0
    bytes = bytes.subspan(size);
  }
  template <class T>
  void operator()(const FieldInfo&, T& value) {
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
    } else if constexpr (std::is_same_v<T, bool>) {
      unsigned char byte = 0;
      raw(&byte, 1);
      value = byte != 0;
    } else {
      raw(&value, sizeof(value));
    }
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, T (&values)[N]) {
    for (T& value : values) (*this)(info, value);
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, char (&text)[N]) {
    std::uint16_t length = 0;
    raw(&length, sizeof(length));
    if (length >= N) ok = false;
    else raw(text, length);
  }
  void operator()(const FieldInfo&, dds_sequence_octet& sequence) {
    std::uint32_t length = 0;
    raw(&length, sizeof(length));
    if (length > bytes.size()) {
      ok = false;
      return;
    }
    octets.resize(length);
    raw(octets.data(), length);
    sequence = {length, length, octets.data(), false};
  }
};

/// A message with the bytes that its sequence points to.
template <class T>
struct Owned {
  Owned() = default;
  explicit Owned(const T& original) : message(original) {}
  T message{};
  std::vector<std::uint8_t> octets;
};

struct OctetsFinder {
  dds_sequence_octet* found = nullptr;
  template <class T>
  void operator()(const FieldInfo&, T&) {}
  void operator()(const FieldInfo&, dds_sequence_octet& octets) { found = &octets; }
};

}  // namespace reflect

/// The first field that violates the IDL, as text with the found and the accepted value; empty if there is none.
/// Floating-point fields must be finite, or NaN where their comment allows it. A valid message costs no heap memory.
template <Described T>
[[nodiscard]] std::optional<std::string> validate(const T& message) {
  reflect::Validator validator;
  Description<T>::visit(message, validator);
  return std::move(validator.found);
}

/// Appends every field in order as deterministic bytes (no padding, little-endian): for hashing, files, checkpoints.
template <Described T>
void canonical_bytes(const T& message, std::string& bytes) {
  Description<T>::visit(message, reflect::ByteWriter{bytes});
}

/// The message that has these canonical bytes; null if they are not exactly one message of this type.
template <Described T>
[[nodiscard]] std::shared_ptr<const T> parse_shared(std::span<const std::byte> bytes) {
  auto owned = std::make_shared<reflect::Owned<T>>();
  reflect::ByteReader reader{bytes, owned->octets};
  Description<T>::visit(owned->message, reader);
  if (!reader.ok || !reader.bytes.empty()) return nullptr;
  return std::shared_ptr<const T>(owned, &owned->message);
}

/// A deep copy.
template <Described T>
[[nodiscard]] std::shared_ptr<T> share_copy(const T& message) {
  auto owned = std::make_shared<reflect::Owned<T>>(message);
  reflect::OctetsFinder finder;
  Description<T>::visit(owned->message, finder);
  if (finder.found && finder.found->_length > 0) {
    owned->octets.assign(finder.found->_buffer, finder.found->_buffer + finder.found->_length);
    *finder.found = {finder.found->_length, finder.found->_length, owned->octets.data(), false};
  } else if (finder.found) {
    *finder.found = {};
  }
  return std::shared_ptr<T>(owned, &owned->message);
}

}  // namespace constrictor
