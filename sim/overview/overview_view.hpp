// The picture of the whole scene from beside the line, for people. The component `overview` publishes it during a run;
// the report draws it for the key moments after the run.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "constrictor/messages.hpp"
#include "sim/overview/overview_config.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/viewpoint.hpp"

namespace constrictor {

/// Draws pictures of one scene from one viewpoint, which follows from the scene and the options, and in a scene without
/// a line also from the places of robot and objects. With the option
/// `inset`, a close-up of the robot covers the lower left corner. A picture is a pure function of the arguments of
/// constructor and draw(). Throws std::runtime_error if OpenGL fails.
class OverviewView {
 public:
  /// `head_camera_m`: [m] p_HC, the position of the robot's camera in its head; the pictures show a small camera there.
  /// The period and the latency of `options` are not used.
  OverviewView(const msg::SceneDescription& description, const OverviewConfig& options,
               const Eigen::Vector3d& head_camera_m);

  /// Returns RGB8 rows from the top, width * height * 3 bytes, valid until the next call.
  [[nodiscard]] std::vector<std::uint8_t>& draw(const msg::WorldState& world);
  /// The camera of the newest picture, with the size of all pictures.
  [[nodiscard]] const PinholeCamera& camera() const { return camera_; }

 private:
  OverviewView(const Scene& scene, const OverviewConfig& options, const RenderOptions& render);
  void look_at_bodies(const ScenePoses& poses);
  void draw_inset(const ScenePoses& poses);

  OverviewConfig options_;
  std::vector<Eigen::Vector3d> extent_;  // what every picture contains
  bool follows_;                         // the bodies: no line tells where they will be
  double heading_rad_;
  PinholeCamera camera_;
  ShadowRegion shadow_;
  Renderer renderer_;
  std::vector<std::uint8_t> rgb_;
};

}  // namespace constrictor
