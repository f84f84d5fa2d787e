// The bridge's two sides: an observer on the robot's topics, and ROS 2's topics with ROS 2's names and types.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "client/request_client.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/wait_set.hpp"
#include "ros_bridge/ros_descriptors.hpp"
#include "ros_bridge/ros_translator.hpp"
#include "ros_bridge/velocity_pilot.hpp"

namespace constrictor::ros {

struct BridgeOptions {
  std::uint32_t domain = 0;         ///< of the run
  std::uint32_t ros_domain = 0;     ///< ROS_DOMAIN_ID of the ROS 2 side
  bool ros_localhost_only = false;  ///< as ROS_LOCALHOST_ONLY=1: no message leaves this host
  std::uint16_t robot_id = 1;
  std::uint8_t level = msg::kAuthorityOperator;  ///< level of the requests for velocities
  double hold_after_s = 0.5;  ///< [s] of wall time without a velocity command after which the robot stands still
  DriveConfig drive;
};

/// Reads as an observer, outside the barrier: no member waits for the bridge, and none reads anything from it. It turns
/// velocities on rt/cmd_vel into requests to `input`, as every client does.
class Bridge {
 public:
  using SteadyClock = std::chrono::steady_clock;
  Bridge(const BridgeOptions& options, RobotModel robot);
  /// Waits for messages, at most 20 ms, and forwards those that have arrived.
  void serve(SteadyClock::time_point now);
  /// True once the run has ended, or its processes are gone.
  [[nodiscard]] bool over() const;
  /// Releases authority if the bridge has it, and waits for the answer. False: no answer within 2 s; authority then
  /// ends half a second after this process.
  bool leave();

 private:
  void pass_out();
  /// Calls `use` for each message that ROS 2 can represent; drops the others and logs the first of them.
  template <class T, class Use>
  void take_fit(const dds::Reader<T>& reader, Use&& use);
  void pass_velocity(SteadyClock::time_point now);

  BridgeOptions options_;
  Translator translator_;
  RequestClient client_;                     ///< on the run's domain
  std::optional<dds::Domain> other_domain_;  ///< empty: ROS 2 is on the run's own domain
  dds::Reader<msg::Tick> tick_;
  dds::Reader<msg::JointState> joints_;
  dds::Reader<msg::ImuState> imu_;
  dds::Reader<msg::RobotPose> pose_;
  dds::Reader<msg::CameraInfo> camera_info_;
  dds::Reader<msg::CameraImage> camera_image_;
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
  std::uint64_t number_ = 0;  ///< of the request that is not answered yet; 0: none
  VelocityPilot pilot_;
  std::string refusal_;  ///< the last reason that was printed
  bool met_ = false, over_ = false, dropped_ = false;
};

}  // namespace constrictor::ros
