// The simulated camera in the robot's head: what `video_capture` is on the real robot.
#pragma once

#include <cstdint>
#include <memory>

#include "robot/robot_model.hpp"
#include "runtime/component.hpp"
#include "sim/render/pixel_noise.hpp"
#include "sim/render/renderer.hpp"

namespace constrictor {

/// Pose of the camera's frame (z along the view, x right, y down) in the head's frame (x forward, y left, z up).
[[nodiscard]] Eigen::Isometry3d camera_mount(const CameraModel& camera);

/// Intrinsics of the robot's camera; its pose is left at the identity.
[[nodiscard]] PinholeCamera camera_intrinsics(const CameraModel& camera);

struct CameraState {
  std::uint64_t frames = 0;  ///< written so far
  template <class Archive>
  void serialize(Archive& archive) { archive(frames); }
};

/// Component `camera`: an image of WorldState every period, with CameraInfo before the first. An image is a function of the
/// world of its tick, of the scene and of the seed, so a restarted camera repeats its images. Writes nothing before scene and
/// world are known. Configuration: camera.yaml; intrinsics, mount, period and latency come from the robot file; light and noise
/// from the scene.
class Camera : public StatefulComponent<CameraState> {
 public:
  Camera(Wiring& wiring, const Setup& setup);
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override;

 private:
  void build(const msg::SceneDescription& description);
  void write_info(const Tick& tick);

  CameraModel model_;
  Timing timing_;
  Eigen::Isometry3d X_HC_;
  RenderOptions options_;
  double shadow_radius_m_;
  std::uint64_t seed_;
  Latest<msg::WorldState> world_;
  Latest<msg::SceneDescription> description_;
  Output<msg::CameraInfo> info_;
  Output<msg::CameraImage> image_;
  std::unique_ptr<Renderer> renderer_;  // rebuilt from the scene, no state
  std::unique_ptr<PixelNoise> noise_;
  std::vector<std::uint8_t> rgb_;
};

ComponentFactory make_camera_factory();

}  // namespace constrictor
