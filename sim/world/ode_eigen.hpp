// Values of ODE as Eigen types.
#pragma once

#include <ode/ode.h>

#include <Eigen/Geometry>

namespace constrictor {

inline Eigen::Vector3d vector_of(const dReal* from) { return {from[0], from[1], from[2]}; }

inline Eigen::Quaterniond quaternion_of(dBodyID body) {
  const dReal* q = dBodyGetQuaternion(body);
  return {q[0], q[1], q[2], q[3]};
}

/// X_WB of a body.
inline Eigen::Isometry3d pose_of(dBodyID body) {
  const dReal* R = dBodyGetRotation(body);  // 3x4, row-major
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.matrix().topRows<3>() << R[0], R[1], R[2], 0.0, R[4], R[5], R[6], 0.0, R[8], R[9], R[10], 0.0;
  pose.translation() = vector_of(dBodyGetPosition(body));
  return pose;
}

}  // namespace constrictor
