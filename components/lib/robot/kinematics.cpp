#include "robot/kinematics.hpp"

#include <cmath>

namespace constrictor {

Eigen::Quaterniond joint_rotation(JointAxis axis, double angle_rad) {
  const Eigen::Vector3d direction = axis == JointAxis::kYaw ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, direction));
}

std::vector<Eigen::Isometry3d> module_poses(const RobotModel& robot, std::span<const double> angles_rad,
                                            const Eigen::Isometry3d& X_WHead) {
  const Eigen::Vector3d p_MJoint(0.5 * robot.module_length_m, 0.0, 0.0);  // of the joint ahead; the one behind is at -p
  std::vector<Eigen::Isometry3d> poses;
  poses.reserve(robot.module_count);
  poses.push_back(X_WHead);
  for (std::size_t i = 0; i + 1 < robot.module_count; ++i) {
    const double angle = i < angles_rad.size() ? angles_rad[i] : 0.0;
    const Eigen::Isometry3d& X_WAhead = poses.back();
    Eigen::Isometry3d X_WBehind = Eigen::Isometry3d::Identity();
    X_WBehind.linear() = X_WAhead.linear() * joint_rotation(robot.joints[i].axis, -angle).toRotationMatrix();
    X_WBehind.translation() = X_WAhead * Eigen::Vector3d(-p_MJoint) - X_WBehind.linear() * p_MJoint;
    poses.push_back(X_WBehind);
  }
  return poses;
}

std::vector<PlanarPose> planar_module_poses(const RobotModel& robot, std::span<const double> angles_rad,
                                            const PlanarPose& head) {
  const double half_m = 0.5 * robot.module_length_m;
  std::vector<PlanarPose> poses;
  poses.reserve(robot.module_count);
  poses.push_back(head);
  for (std::size_t i = 0; i + 1 < robot.module_count; ++i) {
    const PlanarPose ahead = poses.back();
    PlanarPose behind = ahead;
    if (robot.joints[i].axis == JointAxis::kYaw && i < angles_rad.size()) behind.yaw_rad -= angles_rad[i];
    behind.p.x() -= half_m * (std::cos(ahead.yaw_rad) + std::cos(behind.yaw_rad));
    behind.p.y() -= half_m * (std::sin(ahead.yaw_rad) + std::sin(behind.yaw_rad));
    poses.push_back(behind);
  }
  return poses;
}

}  // namespace constrictor
