// The room that a body has when it passes an object and wraps itself round it.
#pragma once

#include "navigation/task.hpp"

namespace constrictor {

/// [m] Least distance between the way of the head and the surfaces of other objects, also those of the same colour, and
/// of obstacles. The head passes the object of the goal's colour, of radius `radius_m`, in the distance `passing_m`,
/// turns beyond it and comes back on the other side. `X_MP`: the object, with the course of the passing line. `side`:
/// +1 if the object stays on the left.
[[nodiscard]] double passing_room_m(const TaskInput& input, const PlanarPose& X_MP, double side, double passing_m,
                                    double radius_m);

}  // namespace constrictor
