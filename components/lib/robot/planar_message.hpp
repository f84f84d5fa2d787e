// Poses of messages in the ground plane.
#pragma once

#include <cmath>

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"

namespace constrictor {

/// Position in the ground plane, and yaw of the x axis.
inline PlanarPose planar(const msg::Pose3& pose) {
  const auto& q = pose.orientation;
  return {{pose.position_m.x, pose.position_m.y},
          std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))};
}

}  // namespace constrictor
