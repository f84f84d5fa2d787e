// The component `camera`: the simulated cameras of the robot.
#pragma once

#include <array>
#include <cereal/types/array.hpp>
#include <cstdint>
#include <memory>

#include "component/component.hpp"
#include "robot/camera_mount.hpp"
#include "robot/robot_model.hpp"
#include "sim/camera/camera_config.hpp"
#include "sim/camera/camera_errors.hpp"
#include "sim/render/pixel_noise.hpp"
#include "sim/render/renderer.hpp"

namespace constrictor {

/// The intrinsics of a camera of the robot, with the identity as its pose.
[[nodiscard]] PinholeCamera camera_intrinsics(const CameraModel& camera);

/// Everything else in an image follows from the world of its tick and from the scene.
struct CameraState {
  std::array<std::uint64_t, msg::kMaxCameras> frames{};  ///< number of written frames of each camera
  template <class Archive>
  void serialize(Archive& archive) {
    archive(frames);
  }
};

/// The component `camera`. It writes an image of the world every period, and CameraInfo with the first image. An image
/// is a function of the world of its tick, the scene and the seed, so a restarted camera repeats its images. The
/// component writes nothing before scene and world are known. Intrinsics, mount, period and latency come from the robot
/// file, light and noise from the scene, the quality of the drawing and further errors from camera.yaml. If the robot
/// has further cameras, each of them exposes at the same ticks as the head's camera.
class Camera : public ConfiguredComponent<CameraState, CameraConfig> {
 public:
  Camera(Wiring& wiring, const Setup& setup);
  [[nodiscard]] Timing timing() const override { return timing_; }
  void step(const Tick& tick) override;

 private:
  /// One camera: its topics, and its mount X_MC on the module that carries it.
  struct Eye {
    std::uint8_t number;
    CameraModel model;
    Eigen::Isometry3d X_MC;
    std::uint64_t seed;
    Output<msg::CameraInfo> info;
    Output<msg::CameraImage> image;
    std::unique_ptr<PixelNoise> noise = nullptr;
  };
  Eye eye(std::size_t number, const CameraModel& model, const Output<msg::CameraInfo>& info,
          const Output<msg::CameraImage>& image) const;
  void build(const msg::SceneDescription& description);
  void write_info(const Tick& tick, const Eye& eye) const;
  void draw(const Eye& eye, const ScenePoses& poses);
  /// Writes the image of the world `now`; `before`: the world of an earlier tick, or null.
  void expose(const Tick& tick, const Eye& eye, const msg::WorldState* before, const msg::WorldState& now);

  RobotModel robot_;
  Timing timing_;
  std::uint64_t seed_;
  ImageErrors errors_;
  // Every tick since the last step: motion blur needs the velocity.
  Events<msg::WorldState> worlds_ = wiring_.events(topics::kWorldState);
  Latest<msg::SceneDescription> description_ = wiring_.latest(topics::kSceneDescription);
  std::vector<Eye> eyes_;               // the head's first
  std::unique_ptr<Renderer> renderer_;  // built from the scene, no state
  std::vector<std::uint8_t> rgb_;
};

ComponentFactory make_camera_factory();

}  // namespace constrictor
