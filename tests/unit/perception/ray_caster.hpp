// A small ray-caster for tests. It draws the ground with a line along a circular arc, round zones and upright
// cylinders, with one light and its shadows. It shares no code with perception.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::testing {

struct Arc {  // in G; it begins at `start` in the direction `heading_rad`; a positive curvature bends to the left
  Eigen::Vector2d start{0.0, 0.0};
  double heading_rad = 0.0;
  double curvature_1_m = 0.0;
  double length_m = 5.0;
  double width_m = 0.05;
  std::uint8_t colour = msg::kColourBlue;

  /// The point at the arc length `s_m` from the start.
  [[nodiscard]] Eigen::Vector2d at(double s_m) const;
  [[nodiscard]] double heading_at(double s_m) const { return heading_rad + curvature_1_m * s_m; }
  /// The smallest arc length [m] at which the arc crosses the coordinate `x_m`; empty if the arc does not cross it.
  [[nodiscard]] std::optional<double> length_at_x(double x_m) const;
};

struct Round {  // a cylinder or a zone, in G
  std::uint8_t colour;
  Eigen::Vector2d centre;
  double radius_m;
  double height_m = 0.0;  // 0: a zone
};

struct Scene {
  std::optional<Arc> line;
  std::vector<Round> rounds;
  Eigen::Vector3d light{0.4, 0.3, 0.85};  // direction towards the light
  double light_intensity = 1.0;
  double ambient = 0.35;
  double noise_sd = 0.0;
  bool gamma = false;
  std::uint64_t seed = 1;
  // Only a RenderedScene has these; the ray-caster's ground is grey and matt.
  Eigen::Vector3d ground_colour{0.5, 0.5, 0.5};  // linear RGB
  double ground_gloss = 0.0;
};

struct Head {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;  // yaw that the IMU reports; it does not change the drawing, because G turns with the head
  double height_m = 0.035;
};

/// The model of a camera that is 0.03 m ahead of and 0.05 m above the centre of the head. By default it has 320 x 240
/// pixels and a field of view of 90 degrees, and is tilted down by 0.3 rad.
msg::CameraInfo camera_info(int width = 320, int height = 240, double horizontal_fov_rad = 1.5708,
                            double tilt_rad = 0.3);
msg::Quaternion orientation(const Head& head);
cv::Mat draw(const Scene& scene, const msg::CameraInfo& info, const Head& head, double tilt_rad = 0.3);

}  // namespace constrictor::testing
