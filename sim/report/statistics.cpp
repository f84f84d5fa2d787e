#include "sim/report/statistics.hpp"

namespace constrictor::report {

std::optional<double> cross_track_m(const Eigen::Vector2d& p, const std::vector<Eigen::Vector2d>& line_m) {
  if (line_m.size() < 2) return std::nullopt;
  double nearest = std::numeric_limits<double>::infinity();
  bool beyond = false;
  for (std::size_t i = 0; i + 1 < line_m.size(); ++i) {
    const Eigen::Vector2d along = line_m[i + 1] - line_m[i];
    const double length2 = along.squaredNorm();
    if (length2 == 0.0) continue;
    const double at = (p - line_m[i]).dot(along) / length2;
    const double distance = (p - line_m[i] - std::clamp(at, 0.0, 1.0) * along).norm();
    if (distance >= nearest) continue;
    nearest = distance;
    beyond = (i == 0 && at < 0.0) || (i + 2 == line_m.size() && at > 1.0);
  }
  if (beyond || !std::isfinite(nearest)) return std::nullopt;
  return nearest;
}

PlanarPose relative_pose(const PlanarPose& X_WA, const PlanarPose& X_WB) {
  return {X_WA.to_local(X_WB.p), wrap_angle(X_WB.yaw_rad - X_WA.yaw_rad)};
}

}  // namespace constrictor::report
