// Room for the U beside the line: the head follows the line, and the arms of the U move beside it.
#pragma once

#include <vector>

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"

namespace constrictor {

/// [m] Lateral distance from the line, positive left, at which the head should drive, so that the axes of all modules
/// stay `room_m` away from the obstacles of the map on both sides. If there is too little room for that, the body is in
/// the middle between the obstacles. 0 if that is so when the head is on the line. Obstacles count from the last module
/// to `ahead_m` before the foremost one, if they are at most 1 m from the line. `X_HL`: a point of the line ahead with
/// the line's heading, in the head's frame; `body`: the modules in the same frame.
[[nodiscard]] double shift_from_line_m(const msg::FieldMap& map, const PlanarPose& X_MH, const PlanarPose& X_HL,
                                       const std::vector<PlanarPose>& body, double room_m, double ahead_m);

}  // namespace constrictor
