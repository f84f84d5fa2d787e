// The robot of guidance's tests.
#pragma once

#include "robot/robot_model.hpp"

namespace constrictor::testing {

/// A snake of 24 modules; yaw and pitch joints alternate.
inline RobotModel snake() {
  RobotModel model;
  model.module_count = 24;
  model.module_length_m = 0.089;
  model.module_radius_m = 0.035;
  model.module_mass_kg = 0.3;
  model.joints.resize(23);
  for (std::size_t i = 0; i < 23; ++i) model.joints[i].axis = i % 2 == 0 ? JointAxis::kYaw : JointAxis::kPitch;
  return model;
}

}  // namespace constrictor::testing
