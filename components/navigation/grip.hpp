// The object in the U of the body, and the monitor that reports its loss.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "navigation/navigation_config.hpp"
#include "navigation/planar_body.hpp"

namespace constrictor {

/// State of the grasp, kept from task to task.
struct Grip {
  bool pregrasped = false;  ///< an object lies beside the body, which can be wrapped round it
  bool carrying = false;    ///< an object is held in the U
  double side = 0.0;        ///< of the head's part of the body on which the object lies: +1 left, -1 right
  std::uint8_t colour = 0;
  std::uint16_t handle = 0;
  double radius_m = 0.085;                          ///< of the object
  double wrap_scale = 1.0;                          ///< width of the open U relative to the usual one
  double height_m = 0.0;                            ///< of the object; 0: unknown
  double hold_torque_nm = 0.0;                      ///< cap of the base joints while carrying
  double usual_torque_nm = 0.0;                     ///< the same while the base has not opened
  Eigen::Vector2d p_MO{0.0, 0.0};                   ///< [m] where the body touched the object
  std::array<double, msg::kMaxJoints> shape_rad{};  ///< posture that holds the object, by yaw joint
  // State of the loss monitor.
  double torque_nm = 0.0;      ///< filtered mean closing torque of the base joints
  double contact_share = 1.0;  ///< filtered share of time in which the base touches something
  double below_s = 0.0;        ///< time for which both have been below their thresholds
  double opened_rad = 0.0;     ///< filtered angle by which the base has opened since the object was taken
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pregrasped, carrying, side, colour, handle, radius_m, wrap_scale, height_m, hold_torque_nm, usual_torque_nm,
            p_MO.x(), p_MO.y());
    for (double& angle : shape_rad) archive(angle);
    archive(torque_nm, contact_share, below_s, opened_rad);
  }
};

/// The first yaw joint of the base of the U, counted from the head, with which both arms of the U are about equally
/// long. The front arm drives and steers: in a short body it stays long enough for that, and the rear arm is short.
[[nodiscard]] int middle_base_joint(const RobotModel& robot, int base_joints);
/// The same, unless the configuration names another one.
[[nodiscard]] int first_base_joint(const RobotModel& robot, const GripConfig& config);

/// Which joints and modules of a robot form the base of the U, and what they measure.
class GripSense {
 public:
  /// Throws ConfigurationError if the configuration names a base that the robot does not have.
  GripSense(const RobotModel& robot, const GripConfig& config);

  /// Why no U of this body can hold an object, for people; empty: it can. The body then has no room for a U with an arm
  /// that drives and steers in front of it, or its joints do not bend to the open U or have less than the torque that
  /// holds an object. The place of a base that the configuration names is taken as it is.
  [[nodiscard]] const std::string& refusal() const { return refusal_; }

  /// Posture of the open U towards `side` (+1 left, -1 right), by yaw joint.
  [[nodiscard]] std::array<double, msg::kMaxJoints> open_shape(double side, double angle_rad) const;
  /// [rad] angle of each base joint in the open U for an object of this radius: base_angle_rad, and less for an object
  /// that would not leave closing_rad to close. A U with parallel arms is as wide as the largest object, which wedges
  /// between the arms before it reaches the base.
  [[nodiscard]] double open_angle_rad(double radius_m) const;
  /// The same for the object of `grip`, with its wrap_scale: a wider U is bent less, but not less than
  /// widest_angle_rad; a narrower one is bent more, but leaves half of closing_rad to close.
  [[nodiscard]] double open_angle_rad(const Grip& grip) const;
  /// [m] radius of the largest object that the U with the angles base_angle_rad can hold: the circle that touches the
  /// middle of each link between the base joints of the U, minus the radius of a module.
  [[nodiscard]] double largest_radius_m() const;
  /// [m] the largest radius as the camera may measure it, which is right to a few percent. What looks larger is not
  /// grasped.
  [[nodiscard]] double largest_seen_radius_m() const { return kMeasured * largest_radius_m(); }
  /// [Nm] largest and mean torque by which the base joints close the U.
  [[nodiscard]] double largest_closing_nm(const msg::JointState& joints, double side) const;
  [[nodiscard]] double mean_closing_nm(const msg::JointState& joints, double side) const;
  /// True if the module belongs to the base.
  [[nodiscard]] bool is_base_module(std::size_t module) const;
  /// True for the modules of the base and for two more on either side.
  [[nodiscard]] bool is_near_base(std::size_t module) const;
  /// [N] sum of the touches on modules of the base.
  [[nodiscard]] double base_force_n(const std::vector<Touch>& touches) const;
  /// [N] sum of the touches in the middle of the base: on modules between its first and its last joint.
  [[nodiscard]] double apex_force_n(const std::vector<Touch>& touches) const;
  /// Number of modules with a touch.
  [[nodiscard]] int touching_modules(const std::vector<Touch>& touches) const;
  /// Centre of an object of this radius that touches the base, in the head's frame.
  [[nodiscard]] Eigen::Vector2d held_object_H(const std::vector<PlanarPose>& body, double radius_m) const;
  /// [rad] Direction in the head's frame to which the mouth of the U points, which is the mean direction of its arms.
  [[nodiscard]] double mouth_rad(const std::vector<PlanarPose>& body) const;
  /// Posture that holds the object, by yaw joint: the measured angles, with each joint of the base closed by a margin
  /// more, which is larger for a robot that does not feel touches. Its U would close visibly without the object. If the
  /// object keeps the base open, the joints beside it close until the arms are parallel.
  [[nodiscard]] std::array<double, msg::kMaxJoints> hold_shape(const msg::JointState& joints, const Grip& grip,
                                                               bool feels) const;

  /// Advances the monitor of the grip by `dt_s`: the torque that holds the posture is larger while the base has opened.
  /// True when the object is lost: torque and touch have been too low for a while, or the torque alone if the robot
  /// feels no touches. While the robot is not to move (`moves` is false) this time does not pass.
  bool watch(const msg::JointState& joints, const std::vector<Touch>& touches, bool feels, double dt_s, Grip& grip,
             bool moves = true) const;
  /// Resets the loss monitor at the beginning of a grasp, and chooses the torque that holds the posture of the grip.
  void hold_starts(Grip& grip) const;

  [[nodiscard]] std::size_t yaw_joint_count() const { return yaw_joints_.size(); }
  /// First yaw joint of the base, counted from the head.
  [[nodiscard]] std::size_t base_first_joint() const { return first_; }

 private:
  static constexpr double kMeasured = 1.06;
  /// Chooses a larger torque while the base has opened. `share`: weight of the new angles in the low-pass.
  void choose_torque(const msg::JointState& joints, bool feels, double share, Grip& grip) const;
  /// Unit vector to which the mouth of the U points, in the head's frame.
  [[nodiscard]] Eigen::Vector2d mouth(const std::vector<PlanarPose>& body) const;
  /// [rad] by which each joint of the base is commanded to close further than the object lets it.
  [[nodiscard]] double margin_rad(bool feels) const {
    return feels ? config_.hold_margin_rad : config_.unfelt_margin_rad;
  }
  [[nodiscard]] double side_m() const;  ///< length of a link between two base joints
  /// [rad] angle of each base joint in the U that touches an object of this radius.
  [[nodiscard]] double closed_angle_rad(double radius_m) const;

  const RobotModel& robot_;
  const GripConfig& config_;
  std::size_t first_;                     ///< yaw joint with which the base begins, counted from the head
  std::vector<std::size_t> yaw_joints_;   ///< indices among all joints
  std::vector<std::size_t> base_joints_;  ///< indices among all joints
  std::string refusal_;
};

}  // namespace constrictor
