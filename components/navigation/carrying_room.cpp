#include "navigation/carrying_room.hpp"

#include <algorithm>

#include "robot/map_points.hpp"

namespace constrictor {

double shift_from_line_m(const msg::FieldMap& map, const PlanarPose& X_MH, const PlanarPose& X_HL,
                         const std::vector<PlanarPose>& body, double room_m, double ahead_m) {
  constexpr double kFar_m = 1.0;  // farther aside, nothing limits the way along the line
  const Eigen::Vector2d head = X_HL.to_local(Eigen::Vector2d::Zero());
  Eigen::Vector2d least = head, most = head;  // the extent of the body along the line and across it
  for (const PlanarPose& module : body) {
    const Eigen::Vector2d p = X_HL.to_local(module.p);
    least = least.cwiseMin(p);
    most = most.cwiseMax(p);
  }
  double left_m = kFar_m, right_m = -kFar_m;  // of the line, of the nearest obstacles
  each_obstacle(map, [&](const Eigen::Vector2d& p_M) {
    const Eigen::Vector2d p = X_HL.to_local(X_MH.to_local(p_M));
    if (p.x() < least.x() || p.x() > most.x() + ahead_m) return;
    if (p.y() > 0.0) left_m = std::min(left_m, p.y());
    else right_m = std::max(right_m, p.y());
  });
  // The bounds of the head's place: the body reaches beyond it on both sides.
  const double most_m = left_m - room_m - (most.y() - head.y());
  const double least_m = right_m + room_m + (head.y() - least.y());
  return least_m < most_m ? std::clamp(0.0, least_m, most_m) : 0.5 * (least_m + most_m);
}

}  // namespace constrictor
