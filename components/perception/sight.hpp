// Lines of sight from the camera: azimuths in frame G, and the vertical planes that they span, as lines of the image.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "perception/ground_camera.hpp"

namespace constrictor::perception {

/// [rad] direction of a pixel's line of sight around the vertical, from x of G, positive left.
[[nodiscard]] double azimuth_rad(const GroundCamera& camera, const Eigen::Vector2d& pixel);

/// Slope of a pixel's line of sight, positive downwards: height over horizontal distance.
[[nodiscard]] double descent(const GroundCamera& camera, const Eigen::Vector2d& pixel);

/// The vertical plane of an azimuth in the image.
struct VerticalPlane {
  Eigen::Vector2d horizon;  ///< [pixel] its point on the horizon
  Eigen::Vector2d down;     ///< unit vector downwards

  /// [pixel] where a walk downwards begins: at the horizon, or at the border of the image if the horizon lies above it.
  [[nodiscard]] Eigen::Vector2d first_in_image() const {
    if (horizon.y() >= 0.0 || down.y() <= 1e-3) return horizon;
    return horizon + (0.01 - horizon.y()) / down.y() * down;
  }
};

/// None if the plane lies behind the camera.
[[nodiscard]] std::optional<VerticalPlane> vertical_plane(const GroundCamera& camera, double azimuth_rad);

/// Where path `i` of `count` crosses something in view, as a share of the way from its right side (0) to its left side
/// (1). The paths are spread evenly over the middle `width` of this way.
[[nodiscard]] double path_share(std::size_t i, std::size_t count, double width);

}  // namespace constrictor::perception
