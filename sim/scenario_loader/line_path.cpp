#include "sim/scenario_loader/line_path.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {
namespace {

/// The frame at the arc length `s` [m] of an arc.
PlanarPose along_arc(const PlanarPose& from, double curvature_1_m, double s) {
  const double turn = curvature_1_m * s;
  // The chord of an arc has the mean heading of the arc.
  const double half = 0.5 * turn;
  const double chord = std::abs(half) < 1e-9 ? s : s * std::sin(half) / half;
  return {from.p + chord * along(from.yaw_rad + half), from.yaw_rad + turn};
}

}  // namespace

LinePath make_line_path(const PlanarPose& begin, const std::vector<LineSegment>& segments, std::size_t most_points) {
  LinePath path;
  path.begin = begin;
  path.end = begin;
  if (segments.empty()) return path;
  double total_m = 0.0;
  for (const LineSegment& segment : segments) total_m += segment.length_m;
  // Rounding up may add one point for each segment.
  const double room = static_cast<double>(most_points - segments.size() - 1);
  const double spacing_m = std::max(0.02, total_m / room);
  path.points_m.push_back(begin.p);
  for (const LineSegment& segment : segments) {
    const int count = std::max(1, static_cast<int>(std::ceil(segment.length_m / spacing_m - 1e-9)));
    for (int i = 1; i <= count; ++i) {
      path.points_m.push_back(along_arc(path.end, segment.curvature_1_m, segment.length_m * i / count).p);
    }
    path.end = along_arc(path.end, segment.curvature_1_m, segment.length_m);
  }
  return path;
}

}  // namespace constrictor
