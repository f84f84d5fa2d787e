// The paints of the simulated scene.
#pragma once

#include <cstdint>
#include <iterator>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Linear RGB reflectance, 0 to 1.
struct Rgb {
  float r = 0.0F;
  float g = 0.0F;
  float b = 0.0F;
};

/// Reflectance of a colour of the messages (msg::kColour…); grey for unknown ones.
[[nodiscard]] constexpr Rgb colour_reflectance(std::uint8_t colour) {
  // One row for each constant kColour… of the IDL, in their order.
  constexpr Rgb kReflectance[] = {
      {0.35F, 0.35F, 0.35F},  // unknown
      {0.04F, 0.50F, 0.09F},  // green
      {0.62F, 0.03F, 0.03F},  // red
      {0.03F, 0.13F, 0.62F},  // blue
      {0.80F, 0.58F, 0.03F},  // yellow
  };
  static_assert(std::size(kReflectance) == msg::kColourCount, "each colour of the IDL needs a row in kReflectance");
  return kReflectance[colour < msg::kColourCount ? colour : msg::kColourUnknown];
}

}  // namespace constrictor
