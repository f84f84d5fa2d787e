// Messages of valid types with absurd values: extremes within their ranges, and sometimes values outside them.
#pragma once

#include <cmath>
#include <limits>

#include "support/field_filler.hpp"

namespace constrictor::testing {

inline constexpr std::uint64_t kMessages = CONSTRICTOR_HOSTILE_MESSAGES;  ///< for each part that is tested
inline constexpr std::uint64_t kSeed = 20261121;

/// Fills every field of a message. One message in four may contain values outside the ranges of the IDL; the others
/// stay within them, so that they pass validation and reach the component.
class HostileFiller : public FieldFiller<HostileFiller> {
 public:
  using FieldFiller::FieldFiller;
  void begin_message() { wild_ = random_() % 4 == 0; }
  [[nodiscard]] std::uint64_t roll(std::uint64_t sides) { return random_() % sides; }

  template <class T>
  T number(const FieldInfo& info) {
    if constexpr (std::is_floating_point_v<T>) return static_cast<T>(real(info));
    else if (info.has_range && !(wild_ && random_() % 8 == 0)) return integer_in_range<T>(info);
    else return static_cast<T>(random_());
  }
  char character() { return wild_ ? static_cast<char>(1 + random_() % 255) : printable_character(); }

 private:
  [[nodiscard]] double real(const FieldInfo& info) {
    static constexpr double kAbsurd[] = {0.0, -0.0, 1e308, -1e308, 5e-324, -1e-300, 1e16, -1e9, 1e6, 1.0};
    if (wild_ && random_() % 16 == 0)
      return random_() % 2 == 0 ? std::nan("") : -std::numeric_limits<double>::infinity();
    if (info.has_range && !(wild_ && random_() % 8 == 0)) {
      const auto which = random_() % 6;
      if (which == 0) return info.min;
      if (which == 1) return info.max;
      return std::uniform_real_distribution<double>(info.min, info.max)(random_);
    }
    if (random_() % 3 == 0) return kAbsurd[random_() % std::size(kAbsurd)];
    return std::normal_distribution<double>(0.0, random_() % 2 == 0 ? 1.0 : 1e4)(random_);
  }

  bool wild_ = false;
};

}  // namespace constrictor::testing
