// The robot's modules in the plane, from its joint angles alone, and the contacts from the side.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// Module centres in the head's frame, head to tail. Pitch joints are taken as 0.
std::vector<PlanarPose> planar_body(const RobotModel& robot, const msg::JointState& joints);

/// A contact from the side, with neither the ground nor the robot itself.
struct Touch {
  std::size_t module = 0;
  Eigen::Vector2d p_H{0.0, 0.0};       ///< [m] in the head's frame
  Eigen::Vector2d normal_H{1.0, 0.0};  ///< unit vector from the touched surface into the module
  double force_n = 0.0;                ///< horizontal part
};

/// The touches of at least `min_force_n`. A contact whose normal is steeper than 45 degrees is with the ground. A
/// contact that lies on another module, by the poses in `body`, is with the robot itself.
std::vector<Touch> lateral_touches(const RobotModel& robot, const std::vector<PlanarPose>& body,
                                   const msg::ContactState& contacts, double min_force_n);

}  // namespace constrictor
