// Makes the values that the renderer draws from the messages of the simulation.
#pragma once

#include "constrictor/messages.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

[[nodiscard]] Eigen::Isometry3d pose_of(const msg::Pose3& pose);
[[nodiscard]] Scene scene_of(const msg::SceneDescription& description);
[[nodiscard]] ScenePoses poses_of(const msg::WorldState& world);

}  // namespace constrictor
