#include "navigation/turn_geometry.hpp"

#include <cmath>
#include <numbers>

namespace constrictor {

TurnTowards turn_towards(const Eigen::Vector2d& target, double radius_m) {
  // The left turn of a mirrored target is the right turn of the target.
  const Eigen::Vector2d from_centre(target.x(), std::abs(target.y()) - radius_m);
  const double squared_m2 = from_centre.squaredNorm() - radius_m * radius_m;
  if (squared_m2 < 0.0) return {};
  TurnTowards result;
  result.straight_m = std::sqrt(squared_m2);
  // At the end of the turn the target is straight_m ahead of the head, and the centre radius_m to its left.
  const double turn_rad = std::atan2(from_centre.y(), from_centre.x()) + std::atan2(radius_m, result.straight_m);
  constexpr double kFullTurn_rad = 2.0 * std::numbers::pi;
  result.turn_rad = turn_rad < 0.0 ? turn_rad + kFullTurn_rad : turn_rad;
  return result;
}

}  // namespace constrictor
