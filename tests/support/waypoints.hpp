// Paths of waypoints for tests of follow_path.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::testing {

/// [m] in M.
struct Point {
  double x_m, y_m;
};

/// Straight for 1 m, then an S-curve of radius 1.25 m; points 0.25 m apart.
inline std::vector<Point> s_curve() {
  std::vector<Point> path{{0, 0}};
  double yaw_rad = 0;
  for (int i = 0; i < 20; ++i) {
    path.push_back({path.back().x_m + 0.25 * std::cos(yaw_rad), path.back().y_m + 0.25 * std::sin(yaw_rad)});
    yaw_rad += i < 3 ? 0.0 : i < 9 ? 0.2 : i < 17 ? -0.2 : 0.0;
  }
  return path;
}

/// The command that starts follow_path as goal 1.
inline msg::TaskCommand follow_path_command(const std::vector<Point>& path) {
  msg::TaskCommand command{};
  command.goal_id = 1;
  command.task = msg::kTaskFollowPath;
  command.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  command.path.point_count = static_cast<std::uint16_t>(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    command.path.x_m[i] = path[i].x_m;
    command.path.y_m[i] = path[i].y_m;
  }
  return command;
}

}  // namespace constrictor::testing
