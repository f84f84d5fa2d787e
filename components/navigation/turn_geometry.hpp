// Plane geometry of a turn towards a target: along a circle until the heading points at the target, then straight on.
#pragma once

#include <Eigen/Core>

namespace constrictor {

/// A turn from the pose (0, 0), heading along x, towards a target.
struct TurnTowards {
  double turn_rad = 0.0;  ///< [0, 2 pi) angle of the turn
  double straight_m =
      -1.0;  ///< distance from the end of the turn to the target; negative: the circle never points at it
};

/// `target` [m] in the frame of the start: the turn begins at (0, 0), heading along x. The turn is to the side of the
/// target, on a circle of `radius_m` > 0.
[[nodiscard]] TurnTowards turn_towards(const Eigen::Vector2d& target, double radius_m);

}  // namespace constrictor
