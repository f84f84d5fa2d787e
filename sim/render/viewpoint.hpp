// Viewpoints of the overview camera. They are pure functions of scene and poses.
#pragma once

#include <vector>

#include "sim/render/renderer.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// The nearest camera that has every point of `points_m` (in W) in the picture, with the fraction `margin` of the
/// picture free at each border. It looks in the direction `heading_rad` (0: along +x, counter-clockwise) and down by
/// `elevation_rad`.
[[nodiscard]] PinholeCamera fit_view(const std::vector<Eigen::Vector3d>& points_m, double heading_rad,
                                     double elevation_rad, double horizontal_fov_rad, int width, int height,
                                     double margin);

/// The part of the ground around the ends of the line that a picture must contain.
struct Surroundings {
  double behind_m = 1.0;      ///< [m] before the beginning of the line, where the robot starts
  double ahead_m = 1.9;       ///< [m] beyond its end, where the objects stand
  double half_width_m = 0.4;  ///< [m] to both sides of the line at these places
};

/// Points that a picture of the whole scene must contain: line, zones, and the surroundings of both ends of the line.
[[nodiscard]] std::vector<Eigen::Vector3d> scene_extent(const Scene& scene, const Surroundings& surroundings);

/// The corners of a rectangle on the ground that contains robot and objects. It is enlarged to multiples of half a
/// metre, so that a view of it stands still while the bodies move a little.
[[nodiscard]] std::vector<Eigen::Vector3d> bodies_extent(const ScenePoses& poses);

/// [rad] heading of a view across the line, from the right of the direction in which the line runs.
[[nodiscard]] double side_heading(const Scene& scene);

/// The region that contains `points_m` and their shadows.
[[nodiscard]] ShadowRegion shadow_region_of(const std::vector<Eigen::Vector3d>& points_m);

}  // namespace constrictor
