// The component `overview`: a camera that stands beside the scene. Its pictures are for people, never for the robot.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "component/component.hpp"
#include "sim/overview/overview_config.hpp"
#include "sim/render/frame_count.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/viewpoint.hpp"

namespace constrictor {

/// The component `overview`. It writes a picture of the whole scene every period. The scene determines the viewpoint.
/// The lower left corner, where the scene is always empty, has a close-up of the robot. A picture is a function of the
/// world of its tick and of the scene. The component writes nothing before both are known.
class Overview : public ConfiguredComponent<FrameCount, OverviewConfig> {
 public:
  Overview(Wiring& wiring, const Setup& setup);
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override;

 private:
  void build(const msg::SceneDescription& description);
  void draw_inset(const ScenePoses& poses);

  Timing timing_;
  Latest<msg::WorldState> world_ = wiring_.latest(topics::kWorldState);
  Latest<msg::SceneDescription> description_ = wiring_.latest(topics::kSceneDescription);
  Output<msg::CameraImage> image_ = wiring_.output(topics::kOverviewImage);
  std::unique_ptr<Renderer> renderer_;  // these members follow from the scene and are no state
  std::unique_ptr<Renderer> inset_renderer_;
  PinholeCamera camera_;
  ShadowRegion shadow_;
  double heading_rad_ = 0.0;
  std::vector<std::uint8_t> rgb_;
};

ComponentFactory make_overview_factory();

}  // namespace constrictor
