// The robot's modules in the plane, from its joint angles alone, and the contacts from the side.
#pragma once

#include <Eigen/Core>
#include <cstdint>
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
  std::uint16_t handle = 0;            ///< of the map's object that stands there; 0: none, so that it is an obstacle
};

/// The touches of at least `min_force_n`. A contact whose normal is steeper than 45 degrees is with the ground. A
/// contact that lies on another module, by the poses in `body`, is with the robot itself.
std::vector<Touch> lateral_touches(const RobotModel& robot, const std::vector<PlanarPose>& body,
                                   const msg::ContactState& contacts, double min_force_n);

/// Fills in the handles of the touches of a robot whose head is at `X_MH`.
void assign_touches(const msg::FieldMap& map, const PlanarPose& X_MH, double usual_radius_m,
                    std::vector<Touch>& touches);

/// The touches that may be those of this object: the map has it there, or nothing. Handle 0: all touches.
[[nodiscard]] std::vector<Touch> touches_of(std::uint16_t handle, const std::vector<Touch>& touches);

}  // namespace constrictor
