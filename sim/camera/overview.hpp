// A camera that stands beside the scene: for people, never for the robot.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "runtime/component.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/viewpoint.hpp"

namespace constrictor {

/// overview.yaml.
struct OverviewConfiguration {
  int width = 640;
  int height = 360;
  int period_ticks = 50;
  int latency_ticks = 25;
  double horizontal_fov_rad = 0.75;
  double elevation_rad = 0.45;      ///< of the camera above the scene
  double heading_rad = 0.6;         ///< turn of the view from looking straight across the line, positive left
  double margin = 0.02;             ///< free part of the picture at each border
  Surroundings surroundings;        ///< of the line's ends that have to be in the picture
  double inset = 0.36;              ///< edge of the close-up of the robot relative to the picture; 0: none
  RenderOptions render;
};

OverviewConfiguration load_overview(const std::filesystem::path& file);

struct OverviewState {
  std::uint64_t frames = 0;  ///< written so far
  template <class Archive>
  void serialize(Archive& archive) { archive(frames); }
};

/// Component `overview`: a picture of the whole scene every period, from a viewpoint that is fixed by the scene, with a close-up
/// of the robot in the lower left corner, where the scene is always empty. A picture is a function of the world of its tick and
/// of the scene. Writes nothing before both are known.
class Overview : public StatefulComponent<OverviewState> {
 public:
  Overview(Wiring& wiring, const Setup& setup);
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override;

 private:
  void build(const msg::SceneDescription& description);
  void draw_inset(const ScenePoses& poses);

  OverviewConfiguration configuration_;
  Timing timing_;
  Latest<msg::WorldState> world_;
  Latest<msg::SceneDescription> description_;
  Output<msg::CameraImage> image_;
  std::unique_ptr<Renderer> renderer_;  // these four follow from the scene, no state
  std::unique_ptr<Renderer> inset_renderer_;
  PinholeCamera camera_;
  ShadowRegion shadow_;
  double heading_rad_ = 0.0;
  std::vector<std::uint8_t> rgb_;
};

ComponentFactory make_overview_factory();

}  // namespace constrictor
