// The scenario as the message that the camera and the report read.
#pragma once

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"
#include "sim/scenario/scenario.hpp"

namespace constrictor {

[[nodiscard]] msg::SceneDescription scene_message(const Scenario& scenario, const RobotModel& robot);

}  // namespace constrictor
