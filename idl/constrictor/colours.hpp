// What the colours of lines, objects and zones look like to people. The names follow from the IDL (constants.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <iterator>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Red, green and blue, 0 to 255.
using Rgb8 = std::array<std::uint8_t, 3>;

struct ColourLook {
  Rgb8 screen;  ///< beside camera images: in perception's picture, Foxglove and RViz
  Rgb8 print;   ///< in the figure and the film: distinguishable also by colour-blind readers
};

/// One row for each constant kColour… of the IDL, in their order.
/// Source of `print`: M. Okabe, K. Ito, "Color Universal Design", 2008.
inline constexpr ColourLook kColourLooks[] = {
    {{128, 128, 128}, {153, 153, 153}},  // unknown
    {{60, 200, 60}, {0, 158, 115}},      // green
    {{220, 60, 60}, {214, 94, 0}},       // red
    {{60, 110, 230}, {0, 115, 179}},     // blue
    {{220, 200, 60}, {240, 227, 66}},    // yellow
};
static_assert(std::size(kColourLooks) == msg::kColourCount, "each colour of the IDL needs a row in kColourLooks");

/// Unknown values have the look of kColourUnknown.
constexpr const ColourLook& look_of(std::uint8_t colour) {
  return kColourLooks[colour < msg::kColourCount ? colour : msg::kColourUnknown];
}

}  // namespace constrictor
