// Whether a scene can exist: nothing overlaps at the start.
#pragma once

#include <string>

#include "sim/scenario/scenario.hpp"

namespace constrictor {

/// What overlaps, in words ("objects[0] overlaps objects[1]"); empty if nothing does. The robot's body is taken as a strip of this
/// length behind the head and this half width.
[[nodiscard]] std::string find_overlap(const Scenario& scenario, double body_length_m, double body_half_width_m);

}  // namespace constrictor
