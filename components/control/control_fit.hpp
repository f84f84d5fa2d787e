// Control for robots with other links, and for longer ones.
#pragma once

#include "control/control_config.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// Angles and weights of links were found for links of 0.178 m (`mamba`). In a body with shorter links, such as one
/// without pitch joints, the base of the same U has more joints, and each of them bends less; the first links, which
/// the wave moves less, are more of them. A longer body undulates less when it nears a zone with an object. A robot
/// without contact sensors keeps the base of the U on the ground.
[[nodiscard]] ControlConfig control_fitted_to(const RobotModel& robot, ControlConfig config);

}  // namespace constrictor
