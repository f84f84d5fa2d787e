// A small ray-caster for tests: the ground with a line along a circular arc and round zones, upright cylinders, one
// light with shadows. Shares no code with perception.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::test {

struct Arc {  // in G: starts at `start`, turns left with `curvature_1_m`
  Eigen::Vector2d start{0.0, 0.0};
  double heading_rad = 0.0;
  double curvature_1_m = 0.0;
  double length_m = 5.0;
  double width_m = 0.05;
  std::uint8_t colour = msg::kColourBlue;

  /// The point at a length along the arc.
  [[nodiscard]] Eigen::Vector2d at(double s_m) const;
  [[nodiscard]] double heading_at(double s_m) const { return heading_rad + curvature_1_m * s_m; }
  /// Length at which the arc passes x (searched from its start); none if it does not.
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
  Eigen::Vector3d light{0.4, 0.3, 0.85};  // towards it
  double light_intensity = 1.0;
  double ambient = 0.35;
  double noise_sd = 0.0;
  bool gamma = false;
  std::uint64_t seed = 1;
};

struct Head {
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;  // of the head in its unit's frame; the scene is drawn in G and does not turn with it
  double height_m = 0.035;
};

/// 320 x 240, 90 degrees, 0.03 m ahead of and 0.05 m above the head's centre, tilted down by 0.3 rad, unless told
/// otherwise.
msg::CameraInfo camera_info(int width = 320, int height = 240, double horizontal_fov_rad = 1.5708,
                            double tilt_rad = 0.3);
msg::Quaternion orientation(const Head& head);
cv::Mat draw(const Scene& scene, const msg::CameraInfo& info, const Head& head, double tilt_rad = 0.3);

}  // namespace constrictor::test
