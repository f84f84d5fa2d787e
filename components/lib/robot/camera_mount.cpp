#include "robot/camera_mount.hpp"

#include <cmath>

namespace constrictor {

Eigen::Isometry3d camera_mount(const CameraModel& camera) {
  const double c = std::cos(camera.tilt_rad);
  const double s = std::sin(camera.tilt_rad);
  const double c_yaw = std::cos(camera.yaw_rad);
  const double s_yaw = std::sin(camera.yaw_rad);
  Eigen::Isometry3d X_HC = Eigen::Isometry3d::Identity();
  X_HC.linear().col(0) = Eigen::Vector3d(s_yaw, -c_yaw, 0.0);
  X_HC.linear().col(1) = Eigen::Vector3d(-s * c_yaw, -s * s_yaw, -c);
  X_HC.linear().col(2) = Eigen::Vector3d(c * c_yaw, c * s_yaw, -s);
  X_HC.translation() = camera.p_HC;
  return X_HC;
}

}  // namespace constrictor
