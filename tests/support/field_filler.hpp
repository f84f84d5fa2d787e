// Fills messages of any type with random values.
#pragma once

#include <cstring>
#include <random>
#include <vector>

#include "constrictor/reflect.hpp"

namespace constrictor::testing {

/// A visitor for Description<T>::visit that fills every field. `Derived` decides on the values: it has
///   T number<T>(const FieldInfo&)   a value for an integer or floating-point field
///   char character()                one character of a text, not 0
/// Texts have a random length; sequences have up to 63 bytes, which live until the next message is filled.
template <class Derived>
class FieldFiller {
 public:
  explicit FieldFiller(std::uint64_t seed) : random_(seed) {}

  template <class T>
  void operator()(const FieldInfo& info, T& value) {
    if constexpr (Described<T>) Description<T>::visit(value, derived());
    else if constexpr (std::is_same_v<T, bool>) value = random_() % 2 == 1;
    else value = derived().template number<T>(info);
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, T (&values)[N]) {
    for (T& value : values) (*this)(info, value);
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, char (&text)[N]) {
    std::memset(text, 0, N);
    const std::size_t length = random_() % N;
    for (std::size_t i = 0; i < length; ++i) text[i] = derived().character();
  }
  void operator()(const FieldInfo&, dds_sequence_octet& sequence) {
    octets_.resize(random_() % 64);
    for (auto& octet : octets_) octet = static_cast<std::uint8_t>(random_());
    const auto length = static_cast<std::uint32_t>(octets_.size());
    sequence = {length, length, octets_.data(), false};
  }

 protected:
  /// A uniformly distributed integer within the range of a field.
  template <class T>
  [[nodiscard]] T integer_in_range(const FieldInfo& info) {
    return static_cast<T>(std::uniform_int_distribution<long long>(static_cast<long long>(info.min),
                                                                   static_cast<long long>(info.max))(random_));
  }
  [[nodiscard]] char printable_character() { return static_cast<char>('!' + random_() % 90); }

  std::mt19937_64 random_;

 private:
  Derived& derived() { return static_cast<Derived&>(*this); }

  std::vector<std::uint8_t> octets_;
};

}  // namespace constrictor::testing
