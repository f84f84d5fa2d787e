// What the body holds, and whether it still does.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "navigation/navigation_config.hpp"
#include "navigation/planar_body.hpp"

namespace constrictor {

/// What the robot knows of its own posture and grasp between tasks.
struct Grip {
  bool pregrasped = false;    ///< the object lies beside the body, ready to be wrapped
  bool carrying = false;      ///< an object is held in the U
  double side = 0.0;          ///< +1: the object is on the left of the head's part of the body, -1: on the right
  std::uint8_t colour = 0;
  std::uint16_t handle = 0;
  double radius_m = 0.085;    ///< of the object
  double hold_torque_nm = 0.0; ///< cap of the base joints while carrying
  Eigen::Vector2d p_MO{0.0, 0.0};  ///< [m] where the object was felt
  std::array<double, msg::kMaxJoints> shape_rad{};  ///< posture that holds it, by yaw joint
  // filters of the loss monitor
  double torque_nm = 0.0;
  double contact_share = 1.0;
  double below_s = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pregrasped, carrying, side, colour, handle, radius_m, hold_torque_nm, p_MO.x(), p_MO.y());
    for (double& angle : shape_rad) archive(angle);
    archive(torque_nm, contact_share, below_s);
  }
};

/// The base of the U seen in the joints and modules of one robot.
class GripSense {
 public:
  GripSense(const RobotModel& robot, const GripConfig& config);

  /// Posture of the open U towards `side`, by yaw joint.
  [[nodiscard]] std::array<double, msg::kMaxJoints> open_shape(double side, double angle_rad) const;
  /// [Nm] largest and mean closing torque of the base joints.
  [[nodiscard]] double largest_closing_nm(const msg::JointState& joints, double side) const;
  [[nodiscard]] double mean_closing_nm(const msg::JointState& joints, double side) const;
  /// True if the module belongs to the base.
  [[nodiscard]] bool is_base_module(std::size_t module) const;
  /// True for these and the two modules on either side.
  [[nodiscard]] bool is_near_base(std::size_t module) const;
  /// [N] sum of the touches on base modules.
  [[nodiscard]] double base_force_n(const std::vector<Touch>& touches) const;
  /// [N] sum of the touches in the middle of the base: on the modules between its first and last joint.
  [[nodiscard]] double apex_force_n(const std::vector<Touch>& touches) const;
  /// Number of modules that touch what lies inside the U.
  [[nodiscard]] int touching_modules(const std::vector<Touch>& touches) const;
  /// Where an object of this radius sits against the base, in the head's frame.
  [[nodiscard]] Eigen::Vector2d held_object_H(const std::vector<Pose2>& body, double radius_m) const;
  /// [m] how far the held object lies beside the head's course while the U goes straight, positive left.
  [[nodiscard]] double held_aside_m(const Grip& grip) const;
  /// Posture by yaw joint as measured, the base closed further by the hold margin.
  [[nodiscard]] std::array<double, msg::kMaxJoints> hold_shape(const msg::JointState& joints, double side) const;

  /// Watches a grasp over `dt_s`. True when it is lost: neither torque nor touch for a while.
  bool lost(const msg::JointState& joints, const std::vector<Touch>& touches, double dt_s, Grip& grip) const;
  /// Starts the watch afresh.
  void hold_starts(Grip& grip) const;

  [[nodiscard]] std::size_t yaw_joint_count() const { return yaw_joints_.size(); }

 private:
  const RobotModel& robot_;
  const GripConfig& config_;
  std::vector<std::size_t> yaw_joints_;
  std::vector<std::size_t> base_joints_;  ///< indices among all joints
};

}  // namespace constrictor
