#include "perception/own_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "robot/kinematics.hpp"
#include "robot/rotation.hpp"

namespace constrictor::perception {
namespace {

constexpr double kSlack_m = 0.002;  // for errors of the measured angles

}  // namespace

OwnBody::OwnBody(const std::vector<Eigen::Isometry3d>& X_CM, double half_length_m, double radius_m, double view_rad)
    : reach_m_(radius_m + kSlack_m) {
  for (const Eigen::Isometry3d& X : X_CM) {
    const Eigen::Vector3d arm = half_length_m * X.linear().col(0);
    const double distance_m = X.translation().norm(), extent_m = half_length_m + reach_m_;
    const double half_rad = distance_m > extent_m ? std::asin(extent_m / distance_m) : std::numbers::pi;
    if (std::acos(std::clamp(X.translation().z() / std::max(distance_m, 1e-9), -1.0, 1.0)) > half_rad + view_rad)
      continue;
    modules_.push_back({X.translation() + arm, X.translation() - arm, X.translation().normalized(), half_rad});
  }
}

bool OwnBody::covers(const Eigen::Vector3d& ray_C, double margin_rad) const {
  const Eigen::Vector3d d = ray_C.normalized();
  return std::any_of(modules_.begin(), modules_.end(), [&](const Module& module) {
    const double wide_rad = module.half_rad + margin_rad;
    if (wide_rad < std::numbers::pi && d.dot(module.direction) < std::cos(wide_rad)) return false;
    // Least distance between the ray (at t) and the straight part (at s): projects onto each of them in turn.
    const Eigen::Vector3d along = module.back - module.front;
    const double square = along.squaredNorm();
    double s = 0.5, t = 0.0;
    for (int i = 0; i < 8; ++i) {
      t = std::max(0.0, (module.front + s * along).dot(d));
      s = std::clamp((t * d - module.front).dot(along) / square, 0.0, 1.0);
    }
    t = std::max(0.0, (module.front + s * along).dot(d));
    return (t * d - module.front - s * along).norm() < reach_m_ + margin_rad * t;
  });
}

OwnBody body_before_head(const msg::CameraInfo& info, const RobotModel& robot, std::span<const double> angles_rad) {
  if (angles_rad.size() != robot.joints.size()) return {};
  constexpr double kSlack_rad = 0.05;
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();
  X_HC.linear() = rotation_from(info.X_HC.orientation);
  const auto& p = info.X_HC.position_m;
  X_HC.translation() = Eigen::Vector3d(p.x, p.y, p.z);
  std::vector<Eigen::Isometry3d> modules = module_poses(robot, angles_rad, X_HC.inverse());
  modules.erase(modules.begin());  // GroundCamera knows the head
  const double across = std::max(info.cx, info.width - info.cx) / info.fx;
  const double down = std::max(info.cy, info.height - info.cy) / info.fy;
  return {modules, 0.5 * robot.module_length_m, robot.module_radius_m,
          std::atan(std::hypot(across, down)) + kSlack_rad};
}

}  // namespace constrictor::perception
