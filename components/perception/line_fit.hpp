// Offset, heading and curvature of the traced line at a distance ahead.
#pragma once

#include <vector>

#include "perception/line_tracer.hpp"

namespace constrictor::perception {

struct LineFit {
  bool valid = false;
  double lookahead_m = 0.0;    ///< the requested distance, or the nearest one at which the line was seen
  double offset_m = 0.0;       ///< lateral position there, positive left
  double heading_rad = 0.0;    ///< relative to x, positive left
  double curvature_1_m = 0.0;  ///< positive bends left
};

/// Robust parabola (iteratively reweighted least squares with Tukey's biweight) through the points around the
/// lookahead, in a frame along the line there. So a line that crosses the view is fitted as well as one that leads
/// ahead. For short pieces the curvature tends to zero (prior of 1.5 1/m).
class LineFitter {
 public:
  [[nodiscard]] LineFit fit(const LineTrace& trace, double lookahead_m);

 private:
  std::vector<double> weight_, residual_, sorted_;  // of the points; kept for their memory
};

}  // namespace constrictor::perception
