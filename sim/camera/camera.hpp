// The component `camera`: the simulated camera in the robot's head.
#pragma once

#include <cstdint>
#include <memory>

#include "component/component.hpp"
#include "robot/camera_mount.hpp"
#include "robot/robot_model.hpp"
#include "sim/camera/camera_config.hpp"
#include "sim/camera/camera_errors.hpp"
#include "sim/render/frame_count.hpp"
#include "sim/render/pixel_noise.hpp"
#include "sim/render/renderer.hpp"

namespace constrictor {

/// The intrinsics of the robot's camera, with the identity as its pose.
[[nodiscard]] PinholeCamera camera_intrinsics(const CameraModel& camera);

/// The component `camera`. It writes an image of the world every period, and CameraInfo with the first image. An image
/// is a function of the world of its tick, the scene and the seed, so a restarted camera repeats its images. The
/// component writes nothing before scene and world are known. Intrinsics, mount, period and latency come from the robot
/// file, light and noise from the scene, the quality of the drawing and further errors from camera.yaml.
class Camera : public ConfiguredComponent<FrameCount, CameraConfig> {
 public:
  Camera(Wiring& wiring, const Setup& setup);
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override;

 private:
  void build(const msg::SceneDescription& description);
  void write_info(const Tick& tick);
  void draw(const ScenePoses& poses);

  CameraModel model_;
  Timing timing_;
  Eigen::Isometry3d X_HC_;
  std::uint64_t seed_;
  ImageErrors errors_;
  // Every tick since the last step: motion blur needs the velocity.
  Events<msg::WorldState> worlds_ = wiring_.events(topics::kWorldState);
  Latest<msg::SceneDescription> description_ = wiring_.latest(topics::kSceneDescription);
  Output<msg::CameraInfo> info_ = wiring_.output(topics::kCameraInfo);
  Output<msg::CameraImage> image_ = wiring_.output(topics::kCameraImage);
  std::unique_ptr<Renderer> renderer_;  // built from the scene, no state
  std::unique_ptr<PixelNoise> noise_;
  std::vector<std::uint8_t> rgb_;
};

ComponentFactory make_camera_factory();

}  // namespace constrictor
