// Poses and vectors in space as messages.
#pragma once

#include <Eigen/Geometry>

#include "constrictor/messages.hpp"

namespace constrictor {

inline msg::Vector3 vector3(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

inline msg::Pose3 pose_message(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d p = pose.translation();
  const Eigen::Quaterniond q(pose.linear());
  return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}};
}

}  // namespace constrictor
