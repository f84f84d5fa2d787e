// The bridge's two sides: an observer on the robot's topics, and a node of ROS 2 with ROS 2's names and types.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "client/request_client.hpp"
#include "client/run_monitor.hpp"
#include "client/run_registry.hpp"
#include "cyclone/endpoint.hpp"
#include "cyclone/entity.hpp"
#include "cyclone/wait_set.hpp"
#include "log/log.hpp"
#include "ros_bridge/ros_diagnostics.hpp"
#include "ros_bridge/ros_drawing.hpp"
#include "ros_bridge/ros_node.hpp"
#include "ros_bridge/ros_translator.hpp"
#include "ros_bridge/task_desk.hpp"
#include "ros_bridge/velocity_pilot.hpp"

namespace constrictor::ros_bridge {

struct BridgeOptions {
  RunNote run;                      ///< which run
  std::uint32_t ros_domain = 0;     ///< ROS_DOMAIN_ID of the ROS 2 side
  bool ros_localhost_only = false;  ///< as ROS_LOCALHOST_ONLY=1: no message leaves this host
  Release release = Release::kIron;
  std::uint16_t robot_id = 1;
  std::uint8_t level = msg::kAuthorityOperator;  ///< level of the requests for velocities and tasks
  double hold_after_s = 0.5;  ///< [s] of wall time without a velocity command after which the robot stands still
  DriveConfig drive;
};

/// Reads as an observer, outside the barrier: no member waits for the bridge, and none reads anything from it. It turns
/// velocities, tasks and emergency stops of ROS programs into requests to `input`, as every client does.
class Bridge {
 public:
  using SteadyClock = std::chrono::steady_clock;
  /// `log`: of the program, for what happens while it serves.
  Bridge(const BridgeOptions& options, const RobotModel& robot, constrictor::Log log);
  /// Waits for messages, at most 20 ms, and forwards those that have arrived.
  void serve(SteadyClock::time_point now);
  /// Why the bridge must end, as text for people; empty while the run goes on.
  [[nodiscard]] const std::string& over() const { return monitor_.attachment().over(); }
  /// Releases authority if the bridge has it, and waits for the answer. False: no answer within 2 s; authority then
  /// ends half a second after this process.
  bool leave();
  /// The node that ROS 2 sees.
  [[nodiscard]] const Node& node() const { return node_; }

 private:
  void pass_robot();
  void pass_images();
  void pass_surroundings();
  void pass_tasks();
  void pass_health(SteadyClock::time_point now);
  /// Calls `use` for each message that ROS 2 can represent; drops the others and logs the first of them.
  template <class T, class Use>
  void take_fit(const dds::Reader<T>& reader, Use&& use);
  /// Counts a message of the run that is not forwarded, and logs the first one.
  void drop(const std::string& reason);
  void take_image(const dds::Reader<msg::CameraImage>& reader, const dds::Writer<Image>& writer, const char* frame);
  void take_stops(SteadyClock::time_point now);
  void take_velocities(SteadyClock::time_point now);
  void take_task_lines(SteadyClock::time_point now);
  void say(const dds::Writer<std_msgs_msg_dds__String_>& writer, const std::string& text);

  using Text = std_msgs_msg_dds__String_;
  using Empty = std_msgs_msg_dds__Empty_;

  BridgeOptions options_;
  constrictor::Log own_log_;  ///< lines of this program
  std::size_t joint_count_;   ///< of the robot file
  Translator translator_;
  Drawing drawing_;
  Health health_;
  RequestClient client_;  ///< on the run's domain
  RunMonitor monitor_;
  dds::Entity ros_domain_;  ///< empty: ROS 2 is on the run's own domain, or Cyclone's default configures its domain
  dds::Entity ros_participant_;
  Node node_;

  // The robot's side.
  dds::Reader<msg::Tick> tick_;
  dds::Reader<msg::ComponentStatus> component_status_;
  dds::Reader<msg::JointState> joints_;
  dds::Reader<msg::ImuState> imu_;
  dds::Reader<msg::RobotPose> pose_;
  dds::Reader<msg::CameraInfo> camera_info_;
  dds::Reader<msg::CameraImage> camera_image_, percept_image_, overview_image_;
  dds::Reader<msg::LinePercept> line_percept_;
  dds::Reader<msg::ObjectPercepts> object_percepts_;
  dds::Reader<msg::FieldMap> map_;
  dds::Reader<msg::TaskCommand> task_command_;
  dds::Reader<msg::TaskStatus> task_status_;
  dds::Reader<msg::TaskEvent> task_event_;
  dds::Reader<msg::LogLine> log_;

  // ROS 2's side.
  dds::Writer<Clock> clock_out_;
  dds::Writer<JointState> joints_out_;
  dds::Writer<Imu> imu_out_;
  dds::Writer<Odometry> odom_out_;
  dds::Writer<TFMessage> tf_out_, tf_static_out_;
  dds::Writer<Image> image_out_, percept_image_out_, overview_image_out_;
  dds::Writer<CameraInfo> camera_info_out_;
  dds::Writer<MarkerArray> map_markers_out_, line_markers_out_, object_markers_out_;
  dds::Writer<Path> line_out_, plan_out_;
  dds::Writer<DiagnosticArray> diagnostics_out_;
  dds::Writer<Log> log_out_;
  dds::Writer<std_msgs_msg_dds__Bool_> stopped_out_;
  dds::Writer<Text> task_answer_out_, task_status_out_, task_event_out_, description_out_;
  Subscription<Twist> velocity_;
  Subscription<Empty> stop_, best_effort_stop_, clear_stop_;
  Subscription<Text> task_;

  dds::WaitSet wait_set_;
  msg::JointState last_joints_{};
  msg::ImuState last_imu_{};
  std::optional<msg::CameraInfo> last_info_;
  std::string last_task_status_;
  std::int64_t period_ns_ = 0;   ///< of a tick
  std::uint64_t plan_goal_ = 0;  ///< the goal whose path /plan shows; 0: none
  std::optional<bool> stopped_;  ///< as published to ROS 2
  std::uint64_t number_ = 0;     ///< of the pilot's request that is not answered yet; 0: none
  std::uint64_t stop_number_ = 0, clear_number_ = 0;
  SteadyClock::time_point stop_asked_{}, health_told_{};
  VelocityPilot pilot_;
  TaskDesk desk_;
  BridgeCounts counts_;
  std::string refusal_;  ///< the last reason that was printed
};

}  // namespace constrictor::ros_bridge
