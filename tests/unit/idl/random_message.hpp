// Messages filled with random valid values, for tests that hold for each type.
#pragma once

#include "support/field_filler.hpp"

namespace constrictor::testing {

/// Fills every field with any value that the IDL allows.
class RandomFiller : public FieldFiller<RandomFiller> {
 public:
  using FieldFiller::FieldFiller;

  template <class T>
  T number(const FieldInfo& info) {
    if constexpr (std::is_floating_point_v<T>) {
      return info.has_range ? std::uniform_real_distribution<T>(T(info.min), T(info.max))(random_)
                            : std::normal_distribution<T>(0, 1000)(random_);
    } else {
      return info.has_range ? integer_in_range<T>(info) : static_cast<T>(random_());
    }
  }
  char character() { return printable_character(); }
};

/// Calls use.template operator()<T>() for each message type.
template <class Use, class... Ts>
void for_each_type(TypeList<Ts...>, Use&& use) {
  (use.template operator()<Ts>(), ...);
}

}  // namespace constrictor::testing
