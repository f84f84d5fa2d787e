// The robot as a model of MuJoCo, another physics engine, in its XML format (MJCF).
#pragma once

#include <string>

#include "robot/robot_model.hpp"

namespace constrictor {

/// The text of an MJCF file for MuJoCo 2.2. The robot lies straight on a ground plane at z = 0. The head has
/// the origin of the world below its centre, and the body lies along -x.
///
/// Names: body and geom `module_0` (the head) to the tail; joint and actuator `joint_0`, ... as in RobotModel, with the
/// same signs of the angles. The control of an actuator is setpoint + (velocity gain / position gain) * rate of the
/// setpoint [rad].
///
/// An elastic joint is two hinges about the same axis: `motor_0` with the actuator, and `spring_0`. The angle of the
/// joint is their sum, the length of the tendon `joint_0`.
///
/// Source: MuJoCo 2.2 documentation, chapter "XML reference".
[[nodiscard]] std::string mujoco_model(const RobotModel& robot);

}  // namespace constrictor
