// Draws what a camera in the head of a robot would see of a simple scene: grey ground, a line, cylinders and discs. It
// shares no code with perception and with the simulator's renderer.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::conform {

/// A line on the ground, in G: it begins at (begin_x_m, begin_y_m) in the direction heading_rad and is an arc.
struct PaintedLine {
  std::uint8_t colour = msg::kColourBlue;
  double begin_x_m = -0.1, begin_y_m = 0.0;
  double heading_rad = 0.0;    ///< positive left
  double curvature_1_m = 0.0;  ///< positive bends left
  double length_m = 5.0, width_m = 0.05;

  [[nodiscard]] Eigen::Vector2d at(double length) const;
  [[nodiscard]] double heading_at(double length) const { return heading_rad + curvature_1_m * length; }
  /// [m] the arc length at which the line first reaches this x.
  [[nodiscard]] double length_at_x(double x_m) const;
  /// [m] distance of a point from the middle of the line; a large number beyond its ends.
  [[nodiscard]] double distance_m(const Eigen::Vector2d& point) const;
};

/// An upright cylinder in G; a disc on the ground if its height is 0.
struct Standing {
  std::uint8_t colour = msg::kColourGreen;
  double x_m = 0.0, y_m = 0.0, radius_m = 0.08, height_m = 0.15;
};

struct SyntheticScene {
  std::optional<PaintedLine> line;
  std::vector<Standing> standing;
  double roll_rad = 0.0, pitch_rad = 0.0;  ///< of the head; positive pitch: nose down
  double noise = 0.01;                     ///< standard deviation of each channel, of full scale
  double light = 1.0;                      ///< 0: black
};

class SyntheticCamera {
 public:
  /// The camera of the robot file.
  explicit SyntheticCamera(const RobotModel& robot);

  [[nodiscard]] msg::CameraInfo info() const;
  /// RGB, rows from the top: height * width * 3 bytes, without noise.
  [[nodiscard]] std::vector<std::uint8_t> draw(const SyntheticScene& scene) const;
  /// The same picture with the noise of the scene; other noise for each `seed`.
  static void add_noise(std::vector<std::uint8_t>& rgb, double noise, std::uint64_t seed);
  /// The pixel coordinates (u, v) of a point of G, seen with a level head.
  [[nodiscard]] Eigen::Vector2d pixel(const Eigen::Vector3d& point) const;
  [[nodiscard]] static msg::Quaternion attitude(const SyntheticScene& scene);

 private:
  [[nodiscard]] Eigen::Isometry3d pose(const SyntheticScene& scene) const;
  CameraModel model_;
  double focal_pixels_, head_height_m_, period_s_;
};

}  // namespace constrictor::conform
