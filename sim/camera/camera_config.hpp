// The parameters of the camera: one row each. camera.yaml and the table in README.md follow from the rows. Optics and
// rate are in the robot file, light and noise in the scenario.
#pragma once

#include "configuration/parameter_set.hpp"

namespace constrictor {

struct CameraConfig : ParameterSet {
  int shadow_map_size = add(shadow_map_size, "shadow_map_size", 512, "texels", {0, 4096}, kAtStart,
                            "Edge of the shadow map; 0: no shadows");
  double shadow_radius_m = add(shadow_radius_m, "shadow_radius_m", 2.2, "m", {0.5, 20.0}, kAtStart,
                               "Radius of the region ahead of the robot in which bodies cast shadows");
  int module_segments = add(module_segments, "module_segments", 16, "", {8, 64}, kAtStart, "Facets around a module");
};

}  // namespace constrictor
