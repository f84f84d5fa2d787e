#include "robot/camera_mount.hpp"

#include <cmath>

namespace constrictor {

Eigen::Isometry3d camera_mount(const CameraModel& camera) {
  const double c = std::cos(camera.tilt_rad);
  const double s = std::sin(camera.tilt_rad);
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();
  X_HC.linear().col(0) = -Eigen::Vector3d::UnitY();
  X_HC.linear().col(1) = Eigen::Vector3d(-s, 0.0, -c);
  X_HC.linear().col(2) = Eigen::Vector3d(c, 0.0, -s);
  X_HC.translation() = camera.p_HC;
  return X_HC;
}

}  // namespace constrictor
