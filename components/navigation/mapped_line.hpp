// The line of the map ahead of the head, for a robot whose camera does not see it.
#pragma once

#include <optional>

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"

namespace constrictor {

/// The point of the mapped line at the distance `lookahead_m` ahead of the head, with the heading of the line, in the
/// head's frame, if the line is there within `aside_m` and goes on ahead. Otherwise the same for the straight way to
/// the nearest point of the line that lies farther ahead, within `reach_m`, or, where the head points out of a bend,
/// for the way to the point of the line at the distance `lookahead_m` from the head. Nothing if there is none.
[[nodiscard]] std::optional<PlanarPose> mapped_line_H(const msg::FieldMap& map, const PlanarPose& X_MH,
                                                      double lookahead_m, double aside_m, double reach_m);

}  // namespace constrictor
