// Forward kinematics of the chain of modules. Frame of a module: x forward (towards the head), y left, z up, origin at
// its centre. A joint angle is the rotation of the head-side module relative to the tail-side one about +z (yaw) or +y
// (pitch).
#pragma once

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "robot/planar.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// Rotation of the head-side module in the tail-side module's frame at this angle.
[[nodiscard]] Eigen::Quaterniond joint_rotation(JointAxis axis, double angle_rad);

/// Poses of all modules, head to tail, in the frame W in which the head's pose is given (the head's own frame by
/// default). `angles_rad` has robot.joints.size() entries; missing ones count as 0.
[[nodiscard]] std::vector<Eigen::Isometry3d> module_poses(
    const RobotModel& robot, std::span<const double> angles_rad,
    const Eigen::Isometry3d& X_WHead = Eigen::Isometry3d::Identity());

/// The same in the plane for a body that lies flat: pitch joints count as 0. One pose for each module, head to tail, in
/// the frame in which `head` is given. Headings are not wrapped: their differences along the body are sums of joint
/// angles.
[[nodiscard]] std::vector<PlanarPose> planar_module_poses(const RobotModel& robot, std::span<const double> angles_rad,
                                                          const PlanarPose& head = {});

}  // namespace constrictor
