// Checks that no bodies overlap at the start, and that no obstacle stands on the line.
#pragma once

#include <string>
#include <vector>

#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

// Length of the body for which a seed draws its scene, whatever the robot is, and half of its width. load_scenario()
// refuses the scene for a longer or wider robot that overlaps something.
inline constexpr double kDrawnBody_m = 2.2;
inline constexpr double kDrawnBodyHalfWidth_m = 0.06;

/// Returns the first overlap in words ("objects[0] overlaps objects[1]"), or an empty text if no bodies overlap. The
/// robot's body is treated as a strip of the given length behind the head, with the given half width.
[[nodiscard]] std::string find_overlap(const Scenario& scenario, double body_length_m = kDrawnBody_m,
                                       double body_half_width_m = kDrawnBodyHalfWidth_m);

/// A text for each obstacle that leaves a robot of this half width no room to move along the line.
[[nodiscard]] std::vector<std::string> find_obstacles_on_line(const Scenario& scenario, double body_half_width_m);

/// A text if the line turns back so sharply, or runs back so near to itself, that the robot may lose it or take one
/// part for the other; otherwise none. README.md ("Lines that turn back") has the measurements behind the bounds.
[[nodiscard]] std::vector<std::string> find_turns_back(const Scenario& scenario);

}  // namespace constrictor
