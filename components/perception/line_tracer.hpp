// Traces the line over the ground plane, from cross-section to cross-section.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "perception/regions.hpp"

namespace constrictor::perception {

/// The traced line, from near to far. Points in G.
struct LineTrace {
  struct Point {
    Eigen::Vector2d p;
    double sd_m;  ///< [m] expected error across the line
  };
  std::vector<Point> points;
  bool end_visible = false;
  Eigen::Vector2d end = Eigen::Vector2d::Zero();  ///< valid if end_visible
};

/// Traces the line of `colour` in the label image. Each step looks at the cross-section of the expected width across
/// the course so far. Where an upright object hides one edge, the other edge and the width of the line give the centre;
/// where it hides both edges, the course is continued. So an object on the line does not bend the trace. The result has
/// no points if there is no line.
LineTrace trace_line(const Labels& labels, const Regions& regions, const GroundCamera& camera,
                     const PerceptionConfig& config, std::uint8_t colour);

}  // namespace constrictor::perception
