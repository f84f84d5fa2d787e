// A line on the ground as a chain of arcs, and the frames at both ends.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "robot/planar.hpp"

namespace constrictor {

/// A segment of constant curvature. A positive curvature bends to the left.
struct LineSegment {
  double length_m = 0.0;
  double curvature_1_m = 0.0;
};

struct LinePath {
  PlanarPose begin;                       ///< frame in W
  PlanarPose end;                         ///< frame in W at the end of the line; its x axis points away from the line
  std::vector<Eigen::Vector2d> points_m;  ///< in W, at most `most_points`
};

/// Joins the segments with continuous heading. The points are 0.02 m apart, or further on long lines.
[[nodiscard]] LinePath make_line_path(const PlanarPose& begin, const std::vector<LineSegment>& segments,
                                      std::size_t most_points);

}  // namespace constrictor
