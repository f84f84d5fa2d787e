// A joint for tests that need no robot file.
#pragma once

#include "robot/robot_model.hpp"

namespace constrictor::testing {

/// A rigid joint of 1.57 rad to both sides, with the servo of mamba.
inline JointModel usual_joint() {
  JointModel joint;
  joint.min_rad = -1.57;
  joint.max_rad = 1.57;
  joint.max_speed_rad_s = 4.0;
  joint.max_torque_nm = 6.0;
  joint.position_gain_nm_rad = 300.0;
  joint.velocity_gain_nm_s_rad = 4.0;
  joint.rotor_inertia_kg_m2 = 0.01;
  return joint;
}

}  // namespace constrictor::testing
