// The bridge's two sides: an observer on the robot's topics, and ROS 2's topics with ROS 2's names and types.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "ros_bridge/ros_descriptors.hpp"
#include "ros_bridge/ros_translator.hpp"
#include "ros_bridge/velocity_pilot.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/outside_link.hpp"
#include "runtime/dds/wait_set.hpp"

namespace constrictor::ros {

struct BridgeOptions {
  std::uint32_t domain = 0;          ///< of the run
  std::uint32_t ros_domain = 0;      ///< ROS_DOMAIN_ID of the ROS 2 side
  bool ros_localhost_only = false;   ///< as ROS_LOCALHOST_ONLY=1: nothing leaves this host
  std::uint16_t robot_id = 1;
  std::uint8_t level = msg::kAuthorityOperator;  ///< as which a velocity command asks
  double hold_after_s = 0.5;         ///< [s] of wall time without a velocity command after which the robot stands still
  DriveConfig drive;
};

/// Reads as an observer does, outside the barrier: nothing of the run waits for it or sees it. What comes in by rt/cmd_vel it asks
/// of `input`, as anybody outside would.
class Bridge {
 public:
  using SteadyClock = std::chrono::steady_clock;
  Bridge(const BridgeOptions& options, RobotModel robot);
  /// Waits for messages, at most 20 ms, and passes on what came.
  void serve(SteadyClock::time_point now);
  /// True once the run is over: its processes said so, or have gone.
  [[nodiscard]] bool over() const;

 private:
  void pass_out();
  /// Takes what may be shown to ROS; says once what was the first that may not.
  template <class T, class Use>
  void take_fit(const dds::Reader<T>& reader, Use&& use);
  void pass_velocity(SteadyClock::time_point now);
  void ask(std::uint8_t kind, const Drive& drive);

  BridgeOptions options_;
  Translator translator_;
  std::string source_;               ///< a name of this process's own
  dds::Domain robot_side_;
  std::optional<dds::Domain> other_domain_;  ///< empty: ROS 2 is on the run's own domain
  dds::Reader<msg::Tick> tick_;
  dds::Reader<msg::JointState> joints_;
  dds::Reader<msg::ImuState> imu_;
  dds::Reader<msg::RobotPose> pose_;
  dds::Reader<msg::CameraInfo> camera_info_;
  dds::Reader<msg::CameraImage> camera_image_;
  dds::RequestWriter request_;
  dds::Reader<msg::Authority> authority_;
  dds::Reader<msg::RequestAnswer> answers_;
  dds::Writer<Clock> clock_out_;
  dds::Writer<JointState> joints_out_;
  dds::Writer<Imu> imu_out_;
  dds::Writer<Odometry> odom_out_;
  dds::Writer<TFMessage> tf_out_, tf_static_out_;
  dds::Writer<Image> image_out_;
  dds::Writer<CameraInfo> camera_info_out_;
  dds::Reader<Twist> velocity_;
  dds::WaitSet wait_set_;
  msg::JointState last_joints_{};
  msg::ImuState last_imu_{};
  std::optional<msg::CameraInfo> last_info_;
  std::uint64_t sequence_ = 0;
  VelocityPilot pilot_;
  std::string refusal_;              ///< the last that was printed
  bool met_ = false, over_ = false, left_out_ = false;
};

}  // namespace constrictor::ros
