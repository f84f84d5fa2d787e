// Translates the robot's messages into ROS 2 messages, and a ROS 2 velocity into a direct motion. Pure: no DDS calls,
// no clock.
//
// Frames follow REP 103 and 105: `odom` is guidance's map frame M (z up, origin on the ground below the head's first
// position). The frames of the modules and of the camera are those of the robot's URDF file (robot/description.hpp).
// Units are SI on both sides.
#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/description.hpp"
#include "robot/robot_model.hpp"
#include "ros_types.h"

namespace constrictor::ros_bridge {

using Clock = rosgraph_msgs_msg_dds__Clock_;
using JointState = sensor_msgs_msg_dds__JointState_;
using Imu = sensor_msgs_msg_dds__Imu_;
using Image = sensor_msgs_msg_dds__Image_;
using CameraInfo = sensor_msgs_msg_dds__CameraInfo_;
using Odometry = nav_msgs_msg_dds__Odometry_;
using TFMessage = tf2_msgs_msg_dds__TFMessage_;
using Twist = geometry_msgs_msg_dds__Twist_;
using Log = rcl_interfaces_msg_dds__Log_;

/// Why ROS 2 cannot represent a message of the robot; empty if it can. Reasons: a value outside the range in the IDL, a
/// time that ROS 2 cannot express, a quaternion that is not a rotation, an image with missing pixels. ROS 2 tools do
/// not check for these errors.
[[nodiscard]] std::string unfit(const msg::Tick& tick);
[[nodiscard]] std::string unfit(const msg::JointState& joints);
[[nodiscard]] std::string unfit(const msg::ImuState& imu);
[[nodiscard]] std::string unfit(const msg::RobotPose& pose);
[[nodiscard]] std::string unfit(const msg::CameraInfo& info);
[[nodiscard]] std::string unfit(const msg::CameraImage& image);
[[nodiscard]] std::string unfit(const msg::LogLine& line);

/// Translates messages for which unfit() is empty. The returned messages point into memory of the translator (names)
/// and of the argument (pixels): write them before either changes.
class Translator {
 public:
  explicit Translator(RobotModel robot);
  Translator(const Translator&) = delete;
  Translator& operator=(const Translator&) = delete;

  [[nodiscard]] Clock clock(std::int64_t time_ns) const;
  /// Effort is the servo's torque [Nm].
  [[nodiscard]] JointState joint_state(const msg::JointState& joints);
  [[nodiscard]] Imu imu(const msg::ImuState& imu);
  /// rgb8, stamped with the time of the exposure.
  [[nodiscard]] Image image(const msg::CameraImage& image, const char* frame = kCameraFrame);
  /// plumb_bob without distortion.
  [[nodiscard]] CameraInfo camera_info(const msg::CameraInfo& info);
  /// Pose in odom, velocity in base_link; the turning rate is the newest of `imu`. Components that motion in the plane
  /// does not have are 0.
  [[nodiscard]] Odometry odometry(const msg::RobotPose& pose, const msg::ImuState& imu);
  /// odom -> base_link by the estimate, and the chain of modules by the joint angles, at the pose's time.
  [[nodiscard]] TFMessage transforms(const msg::RobotPose& pose, const msg::JointState& joints);
  /// The name of the logger is that of the component, or of the process. `period_ns`: the length of a tick.
  /// The time of the line is its tick times this length; a line from before the first tick has the time 0.
  [[nodiscard]] Log log(const msg::LogLine& line, std::int64_t period_ns);
  /// base_link -> camera_optical; constant in a run.
  [[nodiscard]] TFMessage camera_transform(const msg::CameraInfo& info);

 private:
  using TransformStamped = geometry_msgs_msg_dds__TransformStamped_;
  TFMessage tf_message();

  RobotModel robot_;
  std::vector<std::string> joint_names_, module_frames_;
  std::vector<char*> joint_name_pointers_;
  std::vector<TransformStamped> transforms_;
  std::string logger_, message_;
};

/// The constants that convert a velocity into a path.
struct DriveConfig {
  double max_speed_m_s = 0.9;
  double max_curvature_1_m = 2.3;  ///< the curvature with which navigation turns on the spot
  double turn_rad_m = 2.0;         ///< turn on the spot, for each metre along the path with the largest curvature
};

struct Drive {
  double speed_m_s = 0.0;      ///< along the path; negative: backwards; 0: stand
  double curvature_1_m = 0.0;  ///< positive left
  bool operator==(const Drive&) const = default;
};

/// The motion for forward speed linear.x [m/s] and turning rate angular.z [rad/s]; other components are ignored. Stand
/// if the velocity is too low to move, or not finite.
[[nodiscard]] Drive drive_of(const Twist& twist, const DriveConfig& config = {});

}  // namespace constrictor::ros_bridge
