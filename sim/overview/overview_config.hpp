// The parameters of the overview: one row each. overview.yaml and the table in README.md follow from the rows.
#pragma once

#include <string>

#include "configuration/parameter_set.hpp"
#include "sim/render/renderer.hpp"
#include "sim/render/viewpoint.hpp"

namespace constrictor {

struct OverviewConfig : ParameterSet {
  int width = add(width, "width", 640, "pixels", {16, 4096}, kAtStart, "Width of the picture");
  int height = add(height, "height", 360, "pixels", {16, 4096}, kAtStart, "Height of the picture");
  int period_ticks =
      add(period_ticks, "period_ticks", 50, "ticks", {1, 1000}, kAtStart, "Ticks from one picture to the next");
  int latency_ticks =
      add(latency_ticks, "latency_ticks", 25, "ticks", {1, 100}, kAtStart, "Ticks until a picture is visible");
  double horizontal_fov_rad =
      add(horizontal_fov_rad, "horizontal_fov_rad", 0.75, "rad", {0.1, 2.5}, kAtStart, "Horizontal field of view");
  double elevation_rad =
      add(elevation_rad, "elevation_rad", 0.45, "rad", {0.1, 1.5}, kAtStart, "Elevation of the camera above the scene");
  double heading_rad = add(heading_rad, "heading_rad", 0.6, "rad", {-3.2, 3.2}, kAtStart,
                           "Turn from a view straight across the line, positive to the left");
  double margin = add(margin, "margin", 0.02, "", {0.0, 0.4}, kAtStart, "Free fraction of the picture at each border");
  Surroundings surroundings{
      add(surroundings.behind_m, "behind_m", Surroundings{}.behind_m, "m", {0.0, 20.0}, kAtStart,
          "The picture contains the ground before the beginning of the line, where the robot starts"),
      add(surroundings.ahead_m, "ahead_m", Surroundings{}.ahead_m, "m", {0.0, 20.0}, kAtStart,
          "The picture contains the ground beyond the end of the line, where the objects stand"),
      add(surroundings.half_width_m, "half_width_m", Surroundings{}.half_width_m, "m", {0.0, 20.0}, kAtStart,
          "The picture contains the ground to both sides at these places")};
  double inset = add(inset, "inset", 0.36, "", {0.0, 0.6}, kAtStart,
                     "Edge of the close-up of the robot relative to the picture; 0: no close-up");
  RenderOptions render{
      add(render.samples, "samples", 4, "", {1, 4}, kAtStart, "Samples of a pixel: 1, or 4 for smooth edges"),
      add(render.shadow_map_size, "shadow_map_size", 2048, "texels", {0, 8192}, kAtStart,
          "Edge of the shadow map; 0: no shadows"),
      3, add(render.module_segments, "module_segments", 24, "", {8, 64}, kAtStart, "Facets around a module"),
      std::nullopt};

  /// Checks what a range cannot express. Throws ConfigurationError.
  void complete(const Configuration& root) const {
    if (render.samples == 1 || render.samples == 4) return;
    throw root.error("samples", "found " + std::to_string(render.samples) + ", accepted 1 or 4");
  }
};

}  // namespace constrictor
