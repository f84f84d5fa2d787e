// The expectations of `constrictor conform perception`: one row for each value.
#pragma once

#include "configuration/parameter_set.hpp"

namespace constrictor::conform {

struct PerceptionProfile : ParameterSet {
  double answer_s = add(answer_s, "answer_s", 0.2, "s", {0.02, 5.0}, kAtStart,
                        "Time after which the percepts of an image are visible");
  double line_m = add(line_m, "tolerance.line_m", 0.02, "m", {0.001, 0.2}, kAtStart,
                      "Offset and points of the line, up to 0.8 m ahead");
  double heading_rad =
      add(heading_rad, "tolerance.heading_rad", 0.08, "rad", {0.005, 0.5}, kAtStart, "Heading of the line");
  double curvature_share = add(curvature_share, "tolerance.curvature", 0.6, "", {0.05, 0.95}, kAtStart,
                               "Curvature of the line, as a share of it");
  double end_m =
      add(end_m, "tolerance.end_m", 0.06, "m", {0.005, 0.5}, kAtStart, "Distance of the line's end at 0.7 m");
  double bearing_rad =
      add(bearing_rad, "tolerance.bearing_rad", 0.03, "rad", {0.002, 0.3}, kAtStart, "Bearing of an object");
  double range_share = add(range_share, "tolerance.range", 0.1, "", {0.01, 0.5}, kAtStart,
                           "Range of an object or zone, as a share of it");
  double width_share = add(width_share, "tolerance.width", 0.3, "", {0.05, 0.9}, kAtStart,
                           "Width of an object or zone, as a share of it");
  double height_share =
      add(height_share, "tolerance.height", 0.2, "", {0.05, 0.9}, kAtStart, "Height of an object, as a share of it");
  int frozen_after = add(frozen_after, "frozen_after", 10, "images", {0, 1000}, kAtStart,
                         "After so many equal images further ones are refused; 0: they need not be");
};

}  // namespace constrictor::conform
