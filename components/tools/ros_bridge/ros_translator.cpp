#include "ros_bridge/ros_translator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "constrictor/image.hpp"
#include "constrictor/text.hpp"
#include "robot/description.hpp"
#include "robot/kinematics.hpp"
#include "ros_bridge/ros_values.hpp"

namespace constrictor::ros_bridge {
namespace {

dds_sequence_double values_of(const double* values, std::size_t count) {
  dds_sequence_double sequence{};
  sequence._length = sequence._maximum = static_cast<std::uint32_t>(count);
  sequence._buffer = const_cast<double*>(values);
  return sequence;
}

geometry_msgs_msg_dds__Vector3_ vector_of(const msg::Vector3& v) { return {v.x, v.y, v.z}; }
geometry_msgs_msg_dds__Quaternion_ rotation_of(const msg::Quaternion& q) { return {q.x, q.y, q.z, q.w}; }

bool is_rotation(const msg::Quaternion& q) {
  return std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 0.01;
}

}  // namespace

std::string unfit(const msg::Tick& tick) {
  if (auto violation = validate(tick)) return *std::move(violation);
  return sayable(tick.time_ns) ? "" : "time_ns: found " + std::to_string(tick.time_ns) + ", accepted a time of ROS";
}

std::string unfit(const msg::JointState& joints) { return broken(joints); }

std::string unfit(const msg::LogLine& line) {
  auto violation = validate(line);
  return violation ? *std::move(violation) : "";
}

std::string unfit(const msg::RobotPose& pose) { return broken(pose); }

std::string unfit(const msg::ImuState& imu) {
  std::string reason = broken(imu);
  if (reason.empty() && !is_rotation(imu.orientation))
    reason = "orientation: found no rotation, accepted a unit quaternion";
  return reason;
}

std::string unfit(const msg::CameraInfo& info) {
  std::string reason = broken(info);
  if (reason.empty() && !is_rotation(info.X_HC.orientation))
    reason = "X_HC.orientation: found no rotation, accepted a unit quaternion";
  return reason;
}

std::string unfit(const msg::CameraImage& image) {
  std::string reason = broken_exposure(image);
  return reason.empty() ? image_violation(image) : reason;
}

Translator::Translator(RobotModel robot) : robot_(std::move(robot)) {
  for (std::size_t i = 0; i < robot_.joints.size(); ++i) joint_names_.push_back(joint_name(i));
  for (std::size_t i = 0; i < robot_.module_count; ++i) module_frames_.push_back(link_name(i));
  for (auto& name : joint_names_) joint_name_pointers_.push_back(name.data());
}

Clock Translator::clock(std::int64_t time_ns) const { return {time_of(time_ns)}; }

JointState Translator::joint_state(const msg::JointState& joints) {
  const std::size_t count = std::min<std::size_t>(joints.joint_count, joint_names_.size());
  JointState message{};
  message.header = header_of(joints.header.time_ns, text(""));
  message.name._length = message.name._maximum = static_cast<std::uint32_t>(count);
  message.name._buffer = joint_name_pointers_.data();
  message.position = values_of(joints.position_rad, count);
  message.velocity = values_of(joints.velocity_rad_s, count);
  message.effort = values_of(joints.torque_nm, count);
  return message;
}

Imu Translator::imu(const msg::ImuState& imu) {
  Imu message{};  // covariances of 0: unknown
  message.header = header_of(imu.header.time_ns, text(module_frames_.front()));
  message.orientation = rotation_of(imu.orientation);
  message.angular_velocity = vector_of(imu.angular_velocity_rad_s);
  message.linear_acceleration = vector_of(imu.linear_acceleration_m_s2);
  return message;
}

Image Translator::image(const msg::CameraImage& image, const char* frame) {
  Image message{};
  message.header = header_of(exposure_ns(image.header, image.exposure_tick), text(frame));
  message.height = image.height;
  message.width = image.width;
  message.encoding = text("rgb8");
  message.step = 3u * image.width;
  message.data._length = message.data._maximum = image.data._length;
  message.data._buffer = image.data._buffer;
  return message;
}

CameraInfo Translator::camera_info(const msg::CameraInfo& info) {
  static const double kNoDistortion[5] = {};
  CameraInfo message{};
  message.header = header_of(info.header.time_ns, text(kCameraFrame));
  message.height = info.height;
  message.width = info.width;
  message.distortion_model = text("plumb_bob");
  message.d = values_of(kNoDistortion, 5);
  // ROS counts pixel centres from 0, CameraInfo from 0.5.
  const double cx = info.cx - 0.5;
  const double cy = info.cy - 0.5;
  const double k[9] = {info.fx, 0, cx, 0, info.fy, cy, 0, 0, 1};
  const double r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double p[12] = {info.fx, 0, cx, 0, 0, info.fy, cy, 0, 0, 0, 1, 0};
  std::copy(std::begin(k), std::end(k), message.k);
  std::copy(std::begin(r), std::end(r), message.r);
  std::copy(std::begin(p), std::end(p), message.p);
  return message;
}

Odometry Translator::odometry(const msg::RobotPose& pose, const msg::ImuState& imu) {
  Odometry message{};
  message.header = header_of(pose.header.time_ns, text("odom"));
  message.child_frame_id = text(module_frames_.front());
  message.pose.pose.position = {pose.x_m, pose.y_m, robot_.module_radius_m};
  message.pose.pose.orientation = yaw_rotation(pose.yaw_rad);
  // Row-major 6 x 6 of (x, y, z, roll, pitch, yaw) from 3 x 3 of (x, y, yaw).
  constexpr std::size_t kAxis[3] = {0, 1, 5};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      message.pose.covariance[6 * kAxis[row] + kAxis[column]] = pose.covariance[3 * row + column];
    }
  }
  message.twist.twist.linear.x = pose.speed_m_s;
  message.twist.twist.angular.z = imu.angular_velocity_rad_s.z;
  return message;
}

TFMessage Translator::tf_message() {
  TFMessage message{};
  borrow(message.transforms, transforms_);
  return message;
}

TFMessage Translator::transforms(const msg::RobotPose& pose, const msg::JointState& joints) {
  const std::int64_t time_ns = pose.header.time_ns;
  transforms_.clear();
  transforms_.push_back({header_of(time_ns, text("odom")),
                         text(module_frames_.front()),
                         {{pose.x_m, pose.y_m, robot_.module_radius_m}, yaw_rotation(pose.yaw_rad)}});
  const std::size_t count = std::min<std::size_t>(joints.joint_count, robot_.joints.size());
  const auto poses = module_poses(robot_, std::span(joints.position_rad, count));
  const auto link = [&](std::size_t i) -> Eigen::Isometry3d {
    return poses[i] * Eigen::Translation3d(-centre_in_link(robot_, i));
  };
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Eigen::Isometry3d X = link(i - 1).inverse() * link(i);
    const Eigen::Quaterniond q(X.linear());
    const Eigen::Vector3d p = X.translation();
    transforms_.push_back({header_of(time_ns, text(module_frames_[i - 1])),
                           text(module_frames_[i]),
                           {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}}});
  }
  return tf_message();
}

TFMessage Translator::camera_transform(const msg::CameraInfo& info) {
  transforms_.clear();
  transforms_.push_back({header_of(info.header.time_ns, text(module_frames_.front())),
                         text(kCameraFrame),
                         {vector_of(info.X_HC.position_m), rotation_of(info.X_HC.orientation)}});
  return tf_message();
}

Log Translator::log(const msg::LogLine& line, std::int64_t period_ns) {
  // Source: rcl_interfaces/msg/Log.msg.
  constexpr std::uint8_t kInfo = 20, kWarn = 30, kError = 40;
  logger_ = printable(line.component[0] != '\0' ? text_of(line.component) : text_of(line.process));
  message_ = printable(text_of(line.message));
  const bool known =
      line.tick > 0 && period_ns > 0 && line.tick <= std::numeric_limits<std::int64_t>::max() / period_ns;
  const std::int64_t time_ns = known ? line.tick * period_ns : 0;
  Log message{};
  message.stamp = time_of(sayable(time_ns) ? time_ns : 0);
  message.level = line.level == msg::kLogInfo ? kInfo : line.level == msg::kLogWarning ? kWarn : kError;
  message.name = text(logger_);
  message.msg = text(message_);
  message.file = message.function = text("");
  return message;
}

Drive drive_of(const Twist& twist, const DriveConfig& config) {
  constexpr double kStill = 0.01;
  const double speed_m_s = twist.linear.x;
  const double turn_rad_s = twist.angular.z;
  if (!std::isfinite(speed_m_s) || !std::isfinite(turn_rad_s)) return {};
  if (std::abs(speed_m_s) < kStill && std::abs(turn_rad_s) < kStill) return {};
  const double limit = config.max_curvature_1_m;
  // A path of curvature k driven at speed v turns at k v; backwards the same turning rate needs the other curvature.
  const double wanted_1_m = std::abs(speed_m_s) < kStill ? std::copysign(limit, turn_rad_s) : turn_rad_s / speed_m_s;
  const double for_turn_m_s = std::abs(wanted_1_m) < limit ? 0.0 : std::abs(turn_rad_s) / config.turn_rad_m;
  const double path_m_s = std::min(config.max_speed_m_s, std::max(std::abs(speed_m_s), for_turn_m_s));
  return {std::copysign(path_m_s, speed_m_s <= -kStill ? -1.0 : 1.0), std::clamp(wanted_1_m, -limit, limit)};
}

}  // namespace constrictor::ros_bridge
