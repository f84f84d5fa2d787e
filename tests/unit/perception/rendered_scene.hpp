// Rendered camera images for tests of perception: the simulator's renderer in place of the ray-caster.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "ray_caster.hpp"
#include "sim/render/renderer.hpp"

namespace constrictor::testing {

/// Renders test scenes with their line, zones, objects and a straight snake behind the camera.
class RenderedScene {
 public:
  explicit RenderedScene(const Scene& scene);
  ~RenderedScene();
  /// The head is at the origin of G with the given attitude.
  cv::Mat draw(const msg::CameraInfo& info, const Head& head, double tilt_rad = 0.3);

 private:
  Scene scene_;
  std::unique_ptr<Renderer> renderer_;
  ScenePoses poses_;
};

}  // namespace constrictor::testing
