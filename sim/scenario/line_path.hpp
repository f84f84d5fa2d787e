// A line on the ground as a chain of arcs, and the frames at its ends.
#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace constrictor {

/// A stretch of constant curvature (positive bends left).
struct LineSegment {
  double length_m = 0.0;
  double curvature_1_m = 0.0;
};

/// A position with a direction.
struct PlanarFrame {
  Eigen::Vector2d origin_m{0.0, 0.0};
  double yaw_rad = 0.0;

  /// A point given as (ahead, left) in W.
  [[nodiscard]] Eigen::Vector2d point(const Eigen::Vector2d& p) const {
    return origin_m + Eigen::Rotation2Dd(yaw_rad) * p;
  }
};

struct LinePath {
  PlanarFrame begin;
  PlanarFrame end;                       ///< its direction leads on beyond the line
  std::vector<Eigen::Vector2d> points_m; ///< at most `most_points`
};

/// Joins the segments with continuous heading; points every 0.02 m or, on long lines, further apart.
[[nodiscard]] LinePath make_line_path(const PlanarFrame& begin, const std::vector<LineSegment>& segments,
                                      std::size_t most_points);

}  // namespace constrictor
