// The newest messages of a run, from which all views are made. Pure: no sockets, no DDS.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "constrictor/messages.hpp"
#include "constrictor/reflect.hpp"
#include "robot/planar.hpp"

namespace constrictor::views {

/// The newest messages of the run. What is missing is left out of the views.
struct Newest {
  std::optional<msg::SceneDescription> scene;
  std::optional<msg::WorldState> world;
  std::optional<msg::JointState> joints;
  std::optional<msg::ContactState> contacts;
  std::map<std::int64_t, msg::Pose3> heads;  ///< X_WH, the true pose of the head, by tick: the newest ones
  static constexpr std::size_t kMostHeads = 250;
  std::optional<msg::CameraInfo> camera;
  std::optional<msg::LinePercept> line;
  std::optional<msg::ObjectPercepts> blobs;
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

/// Takes over a message, unless it violates the contract. Returns whether it did.
template <class T>
bool keep(std::optional<T>& newest, const T& message) {
  if (validate(message)) return false;
  newest = message;
  return true;
}
/// Likewise. The first one of a new epoch removes what belongs to the epoch before; one of an earlier tick (a replay
/// has gone back) removes the events after it.
bool keep_world(Newest& newest, const msg::WorldState& world);
bool keep_event(Newest& newest, const msg::TaskEvent& event);

/// Sets `newest.start` if it is not known yet and a pose of the same tick as the world has arrived.
void align(Newest& newest);

}  // namespace constrictor::views
