// Checks that no bodies overlap at the start.
#pragma once

#include <string>

#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

/// The first overlap in words ("objects[0] overlaps objects[1]"); empty if there is none. The body of the robot counts
/// as a strip of the given length behind the head and the given half width.
[[nodiscard]] std::string find_overlap(const Scenario& scenario, double body_length_m, double body_half_width_m);

}  // namespace constrictor
