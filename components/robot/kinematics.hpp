// Forward kinematics of the chain of modules. Frame of a module: x forward (towards the head), y left, z up, origin at its
// centre. A joint angle is the rotation of the head-side module relative to the tail-side one about +z (yaw) or +y (pitch).
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor {

/// Rotation of the head-side module in the tail-side module's frame at this angle.
[[nodiscard]] Eigen::Quaterniond joint_rotation(JointAxis axis, double angle_rad);

/// Poses of all modules, head to tail, in the frame W in which the head's pose is given (the head's own frame by default).
/// `angles_rad` has robot.joints.size() entries; missing ones count as 0.
[[nodiscard]] std::vector<Eigen::Isometry3d> module_poses(
    const RobotModel& robot, std::span<const double> angles_rad,
    const Eigen::Isometry3d& X_WHead = Eigen::Isometry3d::Identity());

/// Position and heading of a module in the plane.
struct PlanarPose {
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;  ///< not wrapped: differences along the body are sums of joint angles
};

/// The same in the plane for a body lying flat: pitch joints count as 0. One pose for each module, head to tail.
[[nodiscard]] std::vector<PlanarPose> planar_module_poses(const RobotModel& robot, std::span<const double> angles_rad,
                                                          const PlanarPose& head = {});

/// A point of a module's frame in the frame in which the module's pose is given.
[[nodiscard]] Eigen::Vector2d transform(const PlanarPose& pose, const Eigen::Vector2d& point_m);

}  // namespace constrictor
