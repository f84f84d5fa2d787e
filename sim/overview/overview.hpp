// The component `overview`: a camera that stands beside the scene. Its pictures are for people, never for the robot.
#pragma once

#include <Eigen/Core>
#include <memory>

#include "component/component.hpp"
#include "sim/overview/overview_config.hpp"
#include "sim/overview/overview_view.hpp"
#include "sim/render/frame_count.hpp"

namespace constrictor {

/// The component `overview`. It writes a picture of the whole scene (OverviewView) every period. A picture is a
/// function of the world of its tick and of the scene. The component writes nothing before both are known.
class Overview : public ConfiguredComponent<FrameCount, OverviewConfig> {
 public:
  Overview(Wiring& wiring, const Setup& setup);
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override;

 private:
  Timing timing_;
  Eigen::Vector3d head_camera_m_;  // p_HC
  Latest<msg::WorldState> world_ = wiring_.latest(topics::kWorldState);
  Latest<msg::SceneDescription> description_ = wiring_.latest(topics::kSceneDescription);
  Output<msg::CameraImage> image_ = wiring_.output(topics::kOverviewImage);
  std::unique_ptr<OverviewView> view_;  // built from the scene, no state
};

ComponentFactory make_overview_factory();

}  // namespace constrictor
