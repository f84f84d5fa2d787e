// From the robot's messages to ROS 2's, and from a ROS velocity command to a direct motion. Pure: no DDS calls, no clock.
//
// Frames as REP 103 and 105 have them: `odom` is guidance's map frame M (z up, origin at the head's place at the start, on the ground),
// `base_link` the head module, `module_01` … the others by a chain of joints, `camera_optical` the camera. Units are SI on both sides.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"
#include "ros_types.h"

namespace constrictor::ros {

using Clock = rosgraph_msgs_msg_dds__Clock_;
using JointState = sensor_msgs_msg_dds__JointState_;
using Imu = sensor_msgs_msg_dds__Imu_;
using Image = sensor_msgs_msg_dds__Image_;
using CameraInfo = sensor_msgs_msg_dds__CameraInfo_;
using Odometry = nav_msgs_msg_dds__Odometry_;
using TFMessage = tf2_msgs_msg_dds__TFMessage_;
using Twist = geometry_msgs_msg_dds__Twist_;

/// Why a message of the robot must not be shown to ROS; empty if it may: it breaks what the IDL says of it, its time is none that ROS can
/// say, a rotation is none, an image does not have its pixels. ROS's tools rely on such things and check nothing.
[[nodiscard]] std::string unfit(const msg::Tick& tick);
[[nodiscard]] std::string unfit(const msg::JointState& joints);
[[nodiscard]] std::string unfit(const msg::ImuState& imu);
[[nodiscard]] std::string unfit(const msg::RobotPose& pose);
[[nodiscard]] std::string unfit(const msg::CameraInfo& info);
[[nodiscard]] std::string unfit(const msg::CameraImage& image);

/// Names joints and frames after their place: joint_00 is next to the head.
[[nodiscard]] std::string joint_name(std::size_t joint);
/// base_link is module 0.
[[nodiscard]] std::string module_frame(std::size_t module);

/// Translates what is not unfit. The messages returned point into the translator's own memory (names) and into the argument's (pixels, samples):
/// they are to be written before either changes.
class Translator {
 public:
  explicit Translator(RobotModel robot);
  Translator(const Translator&) = delete;
  Translator& operator=(const Translator&) = delete;

  [[nodiscard]] Clock clock(std::int64_t time_ns) const;
  /// Effort is the servo's torque [Nm].
  [[nodiscard]] JointState joint_state(const msg::JointState& joints);
  [[nodiscard]] Imu imu(const msg::ImuState& imu);
  /// rgb8.
  [[nodiscard]] Image image(const msg::CameraImage& image);
  /// plumb_bob without distortion.
  [[nodiscard]] CameraInfo camera_info(const msg::CameraInfo& info);
  /// Pose in odom, velocity in base_link; the turning rate is the newest of `imu`. What the plane does not have is 0.
  [[nodiscard]] Odometry odometry(const msg::RobotPose& pose, const msg::ImuState& imu);
  /// odom -> base_link by the estimate, and the chain of modules by the joint angles, at the pose's time.
  [[nodiscard]] TFMessage transforms(const msg::RobotPose& pose, const msg::JointState& joints);
  /// base_link -> camera_optical: does not change in a run.
  [[nodiscard]] TFMessage camera_transform(const msg::CameraInfo& info);

 private:
  using TransformStamped = geometry_msgs_msg_dds__TransformStamped_;
  TFMessage tf_message();

  RobotModel robot_;
  std::vector<std::string> joint_names_, module_frames_;
  std::vector<char*> joint_name_pointers_;
  std::vector<TransformStamped> transforms_;
};

/// How a velocity becomes an undulation.
struct DriveConfig {
  double advance_per_cycle_m = 0.9;    ///< travel of one wave; Source: the gait's measured speed, sim/world/README.md
  double max_frequency_hz = 1.0;
  double max_curvature_1_m = 2.3;      ///< navigation's own for turning on the spot
  double turn_rate_at_1hz_rad_s = 1.8; ///< turning on the spot at the largest curvature
};

struct Drive {
  double frequency_hz = 0.0;           ///< 0: stand
  double curvature_1_m = 0.0;          ///< positive left
  bool operator==(const Drive&) const = default;
};

/// Forward speed linear.x [m/s] and turning rate angular.z [rad/s]; the rest a snake on the ground does not have. Too slow to move,
/// or not finite: stand.
[[nodiscard]] Drive drive_of(const Twist& twist, const DriveConfig& config = {});

}  // namespace constrictor::ros
