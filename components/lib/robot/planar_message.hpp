// Poses and orientations of messages in the ground plane.
#pragma once

#include <cmath>

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"

namespace constrictor {

/// [rad] yaw of the x axis in the ground plane. `q` must have the length 1.
inline double yaw_of(const msg::Quaternion& q) {
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), 1.0 - 2.0 * (q.y * q.y + q.z * q.z));
}

/// Position in the ground plane, and yaw of the x axis.
inline PlanarPose planar(const msg::Pose3& pose) {
  return {{pose.position_m.x, pose.position_m.y}, yaw_of(pose.orientation)};
}

}  // namespace constrictor
