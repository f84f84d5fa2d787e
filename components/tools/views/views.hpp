// The content of viewers: messages of the run in forms that Foxglove and the page can show. Pure: no sockets, no DDS.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <vector>

#include "views/newest.hpp"

namespace constrictor::views {

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
/// foxglove.FrameTransforms: "head", "estimated head" and "start" (the frame M of the robot's map) in "world", and
/// "camera" in "head".
[[nodiscard]] nlohmann::json frame_transforms(const Newest& newest, std::uint64_t time_ns);
/// foxglove.Log. A line of a process has the time at which it was written.
[[nodiscard]] nlohmann::json log_of(const msg::TaskEvent& event, std::uint64_t time_ns);
[[nodiscard]] nlohmann::json log_of(const msg::LogLine& line);
/// The state for the page: everything but images, in one object. page_state.cpp shows its fields.
[[nodiscard]] nlohmann::json page_state(const Newest& newest);

}  // namespace constrictor::views
