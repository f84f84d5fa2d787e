// The parameters of the camera: one row each. camera.yaml and the table in README.md follow from the rows. Optics and
// rate are in the robot file, light and noise in the scenario.
#pragma once

#include "configuration/parameter_set.hpp"

namespace constrictor {

/// Errors that are added to the images, as an experiment. The defaults change no byte of the images. Intensity is the
/// light on a pixel: the square of its value, because the display's gamma is a square root.
struct CameraErrorConfig : ParameterSet {
  double dropped_share =
      add(dropped_share, "dropped_share", 0.0, "", {0.0, 1.0}, kAtStart, "Share of the images that are never written");
  double exposure_s =
      add(exposure_s, "exposure_s", 0.0, "s", {0.0, 0.1}, kAtStart, "Time over which an image is exposed: motion blur");
  double blur_pixels = add(blur_pixels, "blur_pixels", 0.0, "pixels", {0.0, 20.0}, kAtStart,
                           "Standard deviation of a Gaussian blur, as of a lens out of focus");
  double gain = add(gain, "gain", 1.0, "", {0.01, 100.0}, kAtStart,
                    "Factor on the intensity, as of a wrong exposure; what is too bright is white");
  double red_gain = add(red_gain, "red_gain", 1.0, "", {0.1, 10.0}, kAtStart,
                        "Factor on the intensity of red, as of a wrong white balance or coloured light");
  double blue_gain = add(blue_gain, "blue_gain", 1.0, "", {0.1, 10.0}, kAtStart, "The same for blue");
  double contrast = add(contrast, "contrast", 1.0, "", {0.05, 5.0}, kAtStart,
                        "Factor on the difference of each channel from medium grey");
};

struct CameraConfig : ParameterSet {
  int shadow_map_size = add(shadow_map_size, "shadow_map_size", 512, "texels", {0, 4096}, kAtStart,
                            "Edge of the shadow map; 0: no shadows");
  double shadow_radius_m = add(shadow_radius_m, "shadow_radius_m", 2.2, "m", {0.5, 20.0}, kAtStart,
                               "Radius of the region ahead of the robot in which bodies cast shadows");
  int module_segments = add(module_segments, "module_segments", 16, "", {8, 64}, kAtStart, "Facets around a module");
  CameraErrorConfig errors = add_section(errors, "error");
};

}  // namespace constrictor
