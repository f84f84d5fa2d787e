// Fits the parameters of navigation to the length of the robot's body.
#pragma once

#include "navigation/navigation_config.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// `config` for this robot. The values of a configuration file are those of a body of 2.136 m (24 modules of `mamba`),
/// for which this function changes nothing. A body of another length gets other curvatures, and a longer one slower
/// controllers and a firmer hold. The README explains each.
[[nodiscard]] NavigationConfig navigation_fitted_to(const RobotModel& robot, NavigationConfig config);

}  // namespace constrictor
