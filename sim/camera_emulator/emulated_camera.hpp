// A camera in the head of the emulated robot: draws the world, adds the faults, and makes JPEG pictures.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"
#include "sim/render/pixel_noise.hpp"
#include "sim/render/renderer.hpp"
#include "sim/scenario_loader/scenario.hpp"

namespace constrictor::camera_emulator {

using Jpeg = std::shared_ptr<const std::vector<std::uint8_t>>;

/// The faults of the camera.
struct CameraFaults {
  bool off = false;     ///< its port refuses connections
  bool silent = false;  ///< connections stay open, but no frame is sent
  bool black = false;
  bool frozen = false;
  double blur_px = 0.0;   ///< standard deviation of the blur; 0: none
  double delay_s = 0.0;   ///< from the exposure to the first byte
  double jitter_s = 0.0;  ///< up to so much is added to the delay of each frame
  double drop = 0.0;      ///< probability that a frame is never sent
};

struct CameraSettings {
  int scale = 1;  ///< the picture has so many times the width and the height of the robot file
  int jpeg_quality = 90;
  CameraFaults usual;  ///< delay, jitter and drops of the healthy camera
};

/// A frame, and when it is sent.
struct EmulatedFrame {
  Jpeg jpeg;             ///< null: the frame is dropped
  double delay_s = 0.0;  ///< from its exposure
};

/// Pure: equal worlds and commands give equal pictures.
class EmulatedCamera {
 public:
  EmulatedCamera(const RobotModel& robot, const Scenario& scenario, std::uint64_t seed, const CameraSettings& settings);
  ~EmulatedCamera();

  /// The next frame of the camera in a world.
  [[nodiscard]] EmulatedFrame expose(const msg::WorldState& world);

  /// Executes a line such as "blur 3". README.md lists the commands. Returns why the line is refused; empty: it was
  /// executed.
  [[nodiscard]] std::string command(const std::string& line);
  [[nodiscard]] const CameraFaults& faults() const { return faults_; }

 private:
  [[nodiscard]] Jpeg picture(const msg::WorldState& world);

  CameraModel model_;
  CameraSettings settings_;
  CameraFaults faults_;
  Eigen::Isometry3d X_HC_;
  std::unique_ptr<Renderer> renderer_;
  PixelNoise noise_;
  std::mt19937_64 random_;
  std::int64_t frames_ = 0;
  std::vector<std::uint8_t> rgb_;
  Jpeg last_;
};

}  // namespace constrictor::camera_emulator
