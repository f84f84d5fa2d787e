// Where the robot's modules are in the plane, by its joint angles alone, and what its skin touches.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "constrictor/messages.hpp"
#include "navigation/pose2.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// Module centres in the head's frame, head to tail. Pitch joints are taken as 0.
std::vector<Pose2> planar_body(const RobotModel& robot, const msg::JointState& joints);

/// A touch from the side: neither the ground nor the robot itself.
struct Touch {
  std::size_t module = 0;
  Eigen::Vector2d p_H{0.0, 0.0};       ///< [m] in the head's frame
  Eigen::Vector2d normal_H{1.0, 0.0};  ///< unit, from what is touched into the module
  double force_n = 0.0;                ///< horizontal
};

/// Lateral touches of at least `min_force_n`. Contacts whose normal is steeper than 45 degrees are the ground's; contacts that lie
/// on another module of the body, by `body`, are the robot's own.
std::vector<Touch> lateral_touches(const RobotModel& robot, const std::vector<Pose2>& body, const msg::ContactState& contacts,
                                   double min_force_n);

}  // namespace constrictor
