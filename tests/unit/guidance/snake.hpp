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
  model.camera.width = 320;
  model.camera.height = 240;
  model.camera.horizontal_fov_rad = 1.57;
  model.camera.p_HC = {0.03, 0.0, 0.05};
  model.camera.tilt_rad = 0.3;
  model.camera.period_ticks = 5;
  model.camera.latency_ticks = 2;
  return model;
}

}  // namespace constrictor::testing
