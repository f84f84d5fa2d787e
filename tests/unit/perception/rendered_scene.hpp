// Rendered camera images for tests of perception: the simulator's renderer in place of the ray-caster.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "perception/line_and_blob_detector.hpp"
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

/// How a rendered scene is lit and how the head is held.
struct RenderedLight {
  Eigen::Vector3d direction;
  double intensity, ambient, noise_sd;
  Head head;
};

inline std::string describe(const RenderedLight& light) {
  return "intensity " + std::to_string(light.intensity) + ", noise " + std::to_string(light.noise_sd);
}

/// What the detector finds in one image of the rendered scene.
inline perception::Percepts look(Scene scene, const RenderedLight& light, std::uint8_t line_colour = msg::kColourBlue) {
  static perception::LineAndBlobDetector detector{perception::PerceptionConfig{}};
  scene.light = light.direction;
  scene.light_intensity = light.intensity;
  scene.ambient = light.ambient;
  scene.noise_sd = light.noise_sd;
  const msg::CameraInfo info = camera_info();
  const cv::Mat image = RenderedScene(scene).draw(info, light.head);
  const perception::GroundCamera camera(info, orientation(light.head), light.head.height_m, {0.0445, 0.035});
  return detector.detect(image, camera, line_colour);
}

}  // namespace constrictor::testing
