// A body that is bent to a U: its base, and the arms beside it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor {

/// The pitch joints that raise the base of a U, with the arms lying on the ground: the nearest one on either side of
/// the joints `first` and `last`, which limit the base. None in two cases: if the two are not opposite each other, so
/// that raising the base would twist it; if an arm is shorter than 0.5 m, and cannot carry the base: the body would
/// lose its course. (With 16 modules, whose rear arm has 0.27 m, two of four missions failed with a raised base.)
[[nodiscard]] inline std::optional<std::array<std::size_t, 2>> base_hinges(const RobotModel& robot, std::size_t first,
                                                                           std::size_t last) {
  constexpr double kLeastArm_m = 0.5;
  const std::size_t shorter = std::min(first + 1, robot.module_count - 1 - last);
  if (first == last || static_cast<double>(shorter) * robot.module_length_m < kLeastArm_m) return std::nullopt;
  for (std::size_t apart = 1; apart <= first && last + apart < robot.joints.size(); ++apart) {
    const bool front = robot.joints[first - apart].axis == JointAxis::kPitch;
    const bool rear = robot.joints[last + apart].axis == JointAxis::kPitch;
    if (front && rear) return std::array{first - apart, last + apart};
    if (front || rear) return std::nullopt;
  }
  return std::nullopt;
}

/// Length of the body relative to that of `mamba`, for which the values of navigation and control were found.
[[nodiscard]] inline double length_share(const RobotModel& robot) {
  constexpr double kTuned_m = 2.136;
  return robot.module_length_m * static_cast<double>(robot.module_count) / kTuned_m;
}

/// [m] Distance of neighbouring yaw joints of `mamba`, for which angles of the base and weights of links were found.
inline constexpr double kTunedLink_m = 0.178;

/// The distance of neighbouring yaw joints, the links of the body seen from above, relative to that of `mamba`; at most
/// 1.
[[nodiscard]] inline double link_share(const RobotModel& robot) {
  const std::vector<std::size_t> joints = robot.yaw_joints();
  if (joints.size() < 2) return 1.0;
  const auto modules = static_cast<double>(joints.back() - joints.front());
  return std::min(1.0, modules * robot.module_length_m / static_cast<double>(joints.size() - 1) / kTunedLink_m);
}

}  // namespace constrictor
