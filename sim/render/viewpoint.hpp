// Where to look from: viewpoints of the overview camera, pure functions of scene and poses.
#pragma once

#include <vector>

#include "sim/render/renderer.hpp"
#include "sim/render/scene.hpp"

namespace constrictor {

/// The camera as near as it can be with every point of `points_m` (in W) in the picture, and `margin` of the picture's size
/// free at each border. Looks in the compass direction `heading_rad` (0: along +x), downwards by `elevation_rad`.
[[nodiscard]] PinholeCamera fit_view(const std::vector<Eigen::Vector3d>& points_m, double heading_rad, double elevation_rad,
                                     double horizontal_fov_rad, int width, int height, double margin);

/// How far the scene reaches beyond its line, in the direction the line has at its ends.
struct Surroundings {
  double behind_m = 1.0;      ///< before its beginning: the robot starts there
  double ahead_m = 1.9;       ///< after its end: the objects stand there
  double half_width_m = 0.4;  ///< to both sides, there
};

/// What a picture of the whole scene has to contain: line, zones, and the surroundings of the line's ends.
[[nodiscard]] std::vector<Eigen::Vector3d> scene_extent(const Scene& scene, const Surroundings& surroundings);

/// Heading that looks across the scene's long side, from the right of the direction in which the line runs.
[[nodiscard]] double side_heading(const Scene& scene);

/// The shadows of everything in `points_m`.
[[nodiscard]] ShadowRegion shadow_region_of(const std::vector<Eigen::Vector3d>& points_m);

}  // namespace constrictor
