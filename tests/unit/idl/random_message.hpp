// Messages filled with random values of every kind, for tests that hold for each type.
#pragma once

#include <cstring>
#include <random>
#include <vector>

#include "constrictor/reflect.hpp"

namespace constrictor::test {

/// Fills every field with any bits its C++ type allows; text has a random length, sequences up to 40 bytes.
class RandomFiller {
 public:
  explicit RandomFiller(std::uint64_t seed) : random_(seed) {}

  template <class T>
  void operator()(const FieldInfo& info, T& value) {
    if constexpr (Described<T>) {
      Description<T>::visit(value, *this);
    } else if constexpr (std::is_same_v<T, bool>) {
      value = random_() % 2 == 1;
    } else if constexpr (std::is_floating_point_v<T>) {
      value = info.has_range ? std::uniform_real_distribution<T>(T(info.min), T(info.max))(random_)
                             : std::normal_distribution<T>(0, 1000)(random_);
    } else if (info.has_range) {
      value = static_cast<T>(std::uniform_int_distribution<long long>(static_cast<long long>(info.min),
                                                                      static_cast<long long>(info.max))(random_));
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
    for (std::size_t i = 0; i < length; ++i) text[i] = static_cast<char>('!' + random_() % 90);
  }
  void operator()(const FieldInfo&, dds_sequence_octet& sequence) {
    octets_.resize(random_() % 40);
    for (auto& octet : octets_) octet = static_cast<std::uint8_t>(random_());
    const auto length = static_cast<std::uint32_t>(octets_.size());
    sequence = {length, length, octets_.data(), false};
  }

 private:
  std::mt19937_64 random_;
  std::vector<std::uint8_t> octets_;
};

/// Calls use.template operator()<T>() for each message type.
template <class Use, class... Ts>
void for_each_type(TypeList<Ts...>, Use&& use) {
  (use.template operator()<Ts>(), ...);
}

}  // namespace constrictor::test
