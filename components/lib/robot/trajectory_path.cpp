#include "robot/trajectory_path.hpp"

#include <cmath>
#include <span>

namespace constrictor {
namespace {

std::span<const msg::TrajectoryPoint> points_of(const msg::DesiredTrajectory& desired) {
  return std::span(desired.points).first(desired.point_count);
}

}  // namespace

void set_arc(double curvature_1_m, msg::DesiredTrajectory& desired) {
  desired.point_count = 1;
  desired.points[0] = {};
  desired.points[0].curvature_1_m = curvature_1_m;
}

bool has_valid_path(const msg::DesiredTrajectory& desired) {
  if (desired.point_count > msg::kMaxTrajectoryPoints) return false;
  const msg::TrajectoryPoint* before = nullptr;
  for (const msg::TrajectoryPoint& point : points_of(desired)) {
    for (const double value : {point.arc_m, point.x_m, point.y_m, point.heading_rad, point.curvature_1_m}) {
      if (!std::isfinite(value)) return false;
    }
    if (before && !(point.arc_m > before->arc_m)) return false;
    before = &point;
  }
  return true;
}

PlanarPose pose_at(const msg::DesiredTrajectory& desired, double arc_m) {
  const auto points = points_of(desired);
  if (points.empty()) return {{arc_m, 0.0}, 0.0};
  const msg::TrajectoryPoint* piece = &points.front();
  for (const msg::TrajectoryPoint& point : points) {
    if (point.arc_m <= arc_m) piece = &point;
  }
  const double along_m = arc_m - piece->arc_m;
  const double turn_rad = piece->curvature_1_m * along_m;
  // The chord of an arc has the mean heading of the arc.
  const double half_rad = 0.5 * turn_rad;
  const double chord_m = std::abs(half_rad) < 1e-6 ? along_m : along_m * std::sin(half_rad) / half_rad;
  return {Eigen::Vector2d(piece->x_m, piece->y_m) + chord_m * along(piece->heading_rad + half_rad),
          piece->heading_rad + turn_rad};
}

double pursuit_curvature_1_m(const msg::DesiredTrajectory& desired, double lookahead_m) {
  const auto points = points_of(desired);
  const double from_m = points.empty() ? 0.0 : points.front().arc_m;
  const Eigen::Vector2d target = pose_at(desired, from_m + lookahead_m).p;
  const double square_m2 = target.squaredNorm();
  return square_m2 > 0.0 ? 2.0 * target.y() / square_m2 : 0.0;
}

}  // namespace constrictor
