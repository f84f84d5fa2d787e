// Messages of valid types with absurd values: extremes within the ranges, and now and then beyond everything.
#pragma once

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "constrictor/reflect.hpp"

namespace constrictor::test {

/// Fills every field. A `wild` message may hold any bits; others stay within the ranges that the IDL names, so that validation
/// lets them through to the component.
class HostileFiller {
 public:
  explicit HostileFiller(std::uint64_t seed) : random_(seed) {}
  void begin_message() { wild_ = random_() % 4 == 0; }
  [[nodiscard]] std::uint64_t roll(std::uint64_t sides) { return random_() % sides; }

  template <class T>
  void operator()(const FieldInfo& info, T& value) {
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
    } else if constexpr (std::is_same_v<T, bool>) {
      value = random_() % 2 == 1;
    } else if constexpr (std::is_floating_point_v<T>) {
      value = static_cast<T>(real(info));
    } else if (info.has_range && !(wild_ && random_() % 8 == 0)) {
      value = static_cast<T>(std::uniform_int_distribution<long long>(static_cast<long long>(info.min), static_cast<long long>(info.max))(random_));
    } else {
      value = static_cast<T>(random_());
    }
  }
  template <class T, std::size_t N>
  void operator()(const FieldInfo& info, T (&values)[N]) {
    for (T& value : values) (*this)(info, value);
  }
  template <std::size_t N>
  void operator()(const FieldInfo&, char (&text)[N]) {
    std::memset(text, 0, N);
    const std::size_t length = random_() % N;
    for (std::size_t i = 0; i < length; ++i) text[i] = static_cast<char>(wild_ ? 1 + random_() % 255 : '!' + random_() % 90);
  }
  void operator()(const FieldInfo&, dds_sequence_octet& sequence) {
    octets_.resize(random_() % 64);
    for (auto& octet : octets_) octet = static_cast<std::uint8_t>(random_());
    const auto length = static_cast<std::uint32_t>(octets_.size());
    sequence = {length, length, octets_.data(), false};
  }

 private:
  [[nodiscard]] double real(const FieldInfo& info) {
    static constexpr double kAbsurd[] = {0.0, -0.0, 1e308, -1e308, 5e-324, -1e-300, 1e16, -1e9, 1e6, 1.0};
    if (wild_ && random_() % 16 == 0) return random_() % 2 == 0 ? std::nan("") : -std::numeric_limits<double>::infinity();
    if (info.has_range && !(wild_ && random_() % 8 == 0)) {
      const auto which = random_() % 6;
      if (which == 0) return info.min;
      if (which == 1) return info.max;
      return std::uniform_real_distribution<double>(info.min, info.max)(random_);
    }
    if (random_() % 3 == 0) return kAbsurd[random_() % std::size(kAbsurd)];
    return std::normal_distribution<double>(0.0, random_() % 2 == 0 ? 1.0 : 1e4)(random_);
  }

  std::mt19937_64 random_;
  bool wild_ = false;
  std::vector<std::uint8_t> octets_;
};

}  // namespace constrictor::test
