// Checks that no bodies overlap at the start.
#pragma once

#include <string>

#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

// The longest robot that is supported, and half of the width of its body.
inline constexpr double kLongestBody_m = 2.2;
inline constexpr double kBodyHalfWidth_m = 0.06;

/// Returns the first overlap in words ("objects[0] overlaps objects[1]"), or an empty text if no bodies overlap. The
/// robot's body is treated as a strip of the given length behind the head, with the given half width.
[[nodiscard]] std::string find_overlap(const Scenario& scenario, double body_length_m = kLongestBody_m,
                                       double body_half_width_m = kBodyHalfWidth_m);

}  // namespace constrictor
