#include "navigation/passing_room.hpp"

#include <algorithm>
#include <limits>

#include "robot/landmarks.hpp"
#include "robot/map_points.hpp"

namespace constrictor {

double passing_room_m(const TaskInput& input, const PlanarPose& X_MP, double side, double passing_m, double radius_m) {
  double least_m = std::numeric_limits<double>::infinity();
  const auto beside = [&](const Eigen::Vector2d& p_M, double other_radius_m) {
    constexpr double kBegin_m = -0.9, kEnd_m = 0.3, kTurn_m = 0.25;  // of the way, along the course
    // The head comes back on the other side, as far as this until the object lies in the base of the U. Beside the lane
    // the turn matters for either side; only the part before the lane tells one side from the other.
    constexpr double kBack_m = -1.8;
    const Eigen::Vector2d p = X_MP.to_local(p_M);
    const double lane_m = (p - Eigen::Vector2d(std::clamp(p.x(), kBegin_m, kEnd_m), -side * passing_m)).norm();
    const double turn_m = (p - Eigen::Vector2d(kTurn_m, 0.0)).norm();
    const double back_m = (p - Eigen::Vector2d(std::clamp(p.x(), kBack_m, kBegin_m), side * passing_m)).norm();
    least_m = std::min({least_m, lane_m - other_radius_m, turn_m - other_radius_m, back_m - other_radius_m});
  };
  for (std::size_t colour = 0; colour < msg::kColourCount; ++colour) {
    const Sighting& other = input.sightings.objects[colour];
    if (other.known && colour != input.parameters.object_colour) beside(other.p_M(), other.radius_m);
  }
  if (!input.map) return least_m;
  // The place of the object itself may differ a little between the map and the way.
  constexpr double kOther_m = 0.25;
  for (const msg::MapObject& twin : landmarks_of(*input.map)) {
    const Eigen::Vector2d p_M(twin.x_m, twin.y_m);
    const bool alike = twin.kind == msg::kBlobObject && twin.colour == input.parameters.object_colour;
    if (alike && (p_M - X_MP.p).norm() > kOther_m) beside(p_M, radius_or(twin, radius_m));
  }
  each_obstacle(*input.map, [&](const Eigen::Vector2d& p_M) {
    constexpr double kOwn = 1.5;  // of the radius: the object itself, where it stood a moment ago
    if ((p_M - X_MP.p).norm() > kOwn * radius_m) beside(p_M, 0.0);
  });
  return least_m;
}

}  // namespace constrictor
