// Which cameras show perception what it needs, as far as the robot's file decides it.
#pragma once

#include "component/check_verdict.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::perception {

/// A warning if the horizon lies above the image of the head's camera: perception then recognises no object that is
/// higher than the camera (README.md, "Limits").
[[nodiscard]] CheckVerdict judge_view(const RobotModel& robot);

}  // namespace constrictor::perception
