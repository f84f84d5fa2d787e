// The arms of a body that is bent to a U.
#pragma once

#include <algorithm>
#include <cstddef>

#include "robot/robot_model.hpp"

namespace constrictor {

/// Whether both arms can carry a raised base of the U. A short one cannot: the body loses its course. With a raised
/// base two of four missions with 16 modules, whose rear arm is 0.27 m long, failed, and none of three without.
/// `first`, `last`: the joints that limit the base; the modules before `first` and behind `last` are the arms.
[[nodiscard]] inline bool arms_carry_base(const RobotModel& robot, std::size_t first, std::size_t last) {
  constexpr double kLeast_m = 0.5;
  const std::size_t shorter = std::min(first + 1, robot.module_count - 1 - last);
  return static_cast<double>(shorter) * robot.module_length_m >= kLeast_m;
}

}  // namespace constrictor
