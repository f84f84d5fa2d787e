// What viewers show: messages of the run in forms that Foxglove and the page know. Pure: no sockets, no DDS.
#pragma once

#include <Eigen/Core>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"

namespace constrictor::dashboard {

/// The newest messages of the run. What is missing is left out of the views.
struct Newest {
  std::optional<msg::SceneDescription> scene;
  std::optional<msg::WorldState> world;
  std::optional<msg::JointState> joints;
  std::optional<msg::ContactState> contacts;
  std::optional<msg::RobotPose> pose;
  std::optional<msg::FieldMap> map;
  std::optional<msg::MissionStatus> mission;
  std::optional<msg::TaskStatus> task;
  std::optional<msg::Authority> authority;
  std::optional<msg::StopState> stop;
  std::optional<msg::RunState> run;
  std::optional<nlohmann::json> replay;  ///< where a replay is; empty: a run is shown
  /// X_WM: the frame of the robot's map in the world, from the first pair of true and estimated pose. At the start of a
  /// run both are the same; a viewer that joins later sees the error of the estimate since then.
  std::optional<PlanarPose> start;
  std::map<std::string, msg::ComponentStatus> processes;  ///< by component
  std::deque<msg::TaskEvent> events;                      ///< the newest ones, the oldest first
  static constexpr std::size_t kMostEvents = 50;
};

/// Sets `newest.start` if it is not known yet and a pose of the same tick as the world has arrived.
void align(Newest& newest);

/// A contact of the robot's skin: where it is, and the force on the robot [N], both in the world's frame W.
struct ContactArrow {
  Eigen::Vector3d p_W;
  Eigen::Vector3d force_W_n;
};
/// The contacts that push sideways. Those that only carry the weight on the ground are left out.
[[nodiscard]] std::vector<ContactArrow> contact_arrows(const Newest& newest);

/// foxglove.SceneUpdate: line, zones, objects and obstacles of the scenario, the robot's modules coloured by the torque
/// of their joint, contact forces as arrows, and the robot's own map. Frame "world".
[[nodiscard]] nlohmann::json scene_update(const Newest& newest, std::uint64_t time_ns);
/// foxglove.FrameTransforms: "head" and "start" (the frame M of the robot's map) in "world".
[[nodiscard]] nlohmann::json frame_transforms(const Newest& newest, std::uint64_t time_ns);
/// foxglove.Log. A line of a process has the time at which it was written.
[[nodiscard]] nlohmann::json log_of(const msg::TaskEvent& event, std::uint64_t time_ns);
[[nodiscard]] nlohmann::json log_of(const msg::LogLine& line);
/// For the page: everything but images, in one object. Documented in README.md.
[[nodiscard]] nlohmann::json page_state(const Newest& newest);
/// The image as ROS 2's sensor_msgs/msg/Image in CDR, or nothing if its number of bytes does not fit its size.
[[nodiscard]] std::optional<std::string> ros_image(const msg::CameraImage& image, const std::string& frame,
                                                   std::uint64_t time_ns);
/// The schema of ros_image().
[[nodiscard]] const char* ros_image_schema();

}  // namespace constrictor::dashboard
