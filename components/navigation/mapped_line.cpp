#include "navigation/mapped_line.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace constrictor {
namespace {

/// [m] Offset of the mapped point nearest to the axis of the head among those at about the distance `ahead_m`; NaN if
/// there is none within `aside_m`.
double offset_m(const msg::FieldMap& map, const PlanarPose& X_MH, double ahead_m, double aside_m) {
  constexpr double kBand_m = 0.15;
  double found_m = std::numeric_limits<double>::quiet_NaN();
  double least_m = aside_m;
  const auto count = std::min<std::size_t>(map.line_point_count, msg::kMaxMapLinePoints);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d p = X_MH.to_local({map.line_x_m[i], map.line_y_m[i]});
    if (std::abs(p.x() - ahead_m) > kBand_m || std::abs(p.y()) > least_m) continue;
    least_m = std::abs(p.y());
    found_m = p.y();
  }
  return found_m;
}

/// The mapped point nearest to the head among those within `reach_m` and 60 degrees of the heading.
std::optional<Eigen::Vector2d> nearest_ahead(const msg::FieldMap& map, const PlanarPose& X_MH, double reach_m) {
  constexpr double kCone = 1.732;  // tangent of 60 degrees
  std::optional<Eigen::Vector2d> best;
  const auto count = std::min<std::size_t>(map.line_point_count, msg::kMaxMapLinePoints);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d p = X_MH.to_local({map.line_x_m[i], map.line_y_m[i]});
    if (p.norm() < (best ? best->norm() : reach_m) && std::abs(p.y()) < kCone * p.x()) best = p;
  }
  return best;
}

}  // namespace

std::optional<PlanarPose> mapped_line_H(const msg::FieldMap& map, const PlanarPose& X_MH, double lookahead_m,
                                        double aside_m, double reach_m) {
  constexpr double kFurther_m = 0.4;
  const double here_m = offset_m(map, X_MH, lookahead_m, aside_m);
  const double further_m = offset_m(map, X_MH, lookahead_m + kFurther_m, aside_m);
  const double more_m = further_m - here_m;
  if (std::abs(more_m) < kFurther_m)  // false for NaN
    return PlanarPose{{lookahead_m, here_m}, std::atan2(more_m, kFurther_m)};
  // The line begins farther ahead: the straight way to its nearest point counts as a line.
  const auto p = nearest_ahead(map, X_MH, reach_m);
  if (!p || p->x() < lookahead_m) return std::nullopt;
  return PlanarPose{{lookahead_m, lookahead_m * p->y() / p->x()}, std::atan2(p->y(), p->x())};
}

}  // namespace constrictor
