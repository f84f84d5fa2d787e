// The points of guidance's map.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Calls `visit` with the place [m] in M (Eigen::Vector2d) of each obstacle of the map.
template <class Visit>
void each_obstacle(const msg::FieldMap& map, Visit visit) {
  const auto count = std::min<std::size_t>(map.obstacle_count, msg::kMaxMapObstacles);
  for (std::size_t i = 0; i < count; ++i) visit(Eigen::Vector2d(map.obstacle_x_m[i], map.obstacle_y_m[i]));
}

/// The same for each point of the line.
template <class Visit>
void each_line_point(const msg::FieldMap& map, Visit visit) {
  const auto count = std::min<std::size_t>(map.line_point_count, msg::kMaxMapLinePoints);
  for (std::size_t i = 0; i < count; ++i) visit(Eigen::Vector2d(map.line_x_m[i], map.line_y_m[i]));
}

}  // namespace constrictor
