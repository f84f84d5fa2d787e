// Whether a mission without objects has really succeeded, for everything that judges it by the true world.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <string>
#include <vector>

namespace constrictor {

/// What a mission without objects lacks when it ends with the head at this place: the task ends before the head has
/// reached the last point of the line, at most 0.7 m from it. Empty: nothing. All points are in W.
[[nodiscard]] inline std::string line_shortfall(const Eigen::Vector2d& head_m,
                                                const std::vector<Eigen::Vector2d>& line_m) {
  constexpr double kAtEnd_m = 0.7;
  if (line_m.empty()) return "the scenario has neither objects to retrieve nor a line";
  const double distance_m = (head_m - line_m.back()).norm();
  return distance_m <= kAtEnd_m ? "" : fmt::format("the head is {:.2f} m from the end of the line", distance_m);
}

}  // namespace constrictor
