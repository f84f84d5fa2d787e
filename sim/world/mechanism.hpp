// The bodies and joints of a robot in a scene, as an engine receives them.
#pragma once

#include <Eigen/Geometry>

#include "robot/robot_model.hpp"
#include "sim/scenario_loader/scenario.hpp"
#include "sim/world/dynamics.hpp"

namespace constrictor {

/// The robot is straight and at its start, the objects are where the scenario puts them.
[[nodiscard]] Mechanism mechanism_of(const RobotModel& robot, const Scenario& scenario);

/// The pose of a body that stands upright, with its centre at this place and height.
[[nodiscard]] Eigen::Isometry3d upright_pose(const Eigen::Vector2d& position_m, double height_m, double yaw_rad);

}  // namespace constrictor
