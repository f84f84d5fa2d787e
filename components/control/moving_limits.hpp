// Which robots control's gaits can move, as far as their joints decide it. How slippery the ground is, no component
// knows.
#pragma once

#include "component/robot_bounds.hpp"
#include "control/control_config.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// What is wrong with the joints of this robot: range, rate or torque of most of its yaw joints. The bounds are
/// measured (README.md): with less than the one the robot covers less than a twentieth of its usual way, and with less
/// than the other less than a quarter.
[[nodiscard]] CheckVerdict judge_joints(const RobotModel& robot, const ControlConfig& config);

}  // namespace constrictor
