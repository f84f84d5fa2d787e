// Which robots control's gaits can move, as far as their joints decide it. How slippery the ground is, no component
// knows.
#pragma once

#include "component/robot_bounds.hpp"
#include "control/control_config.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// What is wrong with this robot and its methods for moving without an object: a method with which the robot loses its
/// pose; range, rate, torque or position gain of most of its yaw joints, or the number of its modules. The bounds are
/// measured with undulation (README.md), and judged only where the robot travels by it: with a range, rate or torque
/// below the one the robot covers less than a twentieth of its usual way, and below the other less than a quarter.
[[nodiscard]] CheckVerdict judge_joints(const RobotModel& robot, const ControlConfig& config);

}  // namespace constrictor
