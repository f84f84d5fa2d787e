// The scenario as the message that the camera and the report read.
#pragma once

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"
#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

[[nodiscard]] msg::SceneDescription scene_description(const Scenario& scenario, const RobotModel& robot);

}  // namespace constrictor
