// The search of a robot that knows neither where the line is nor where the zone is.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "constrictor/messages.hpp"
#include "robot/planar.hpp"

namespace constrictor {

/// Leads the robot over the ground around the place where the search began, on an expanding square: the sides are 1, 1,
/// 2, 2, 3, 3… steps long, with a corner to the left between two of them. This is the expanding square search of
/// searches at sea (IAMSAR Manual, volume II).
class Sweep {
 public:
  /// Another search begins.
  void end() { sides_ = 0; }
  /// Takes the pose of the head in M and the time [s], and chooses the corner to go to. A side ends when the robot
  /// comes within a quarter of a step of it or passes it, also beside it, or after `side_s` for each of its steps.
  void lead(const msg::RobotPose& pose, double now_s, double step_m, double side_s) {
    if (sides_ == 0) {
      corner_x_m_ = pose.x_m;
      corner_y_m_ = pose.y_m;
      heading_rad_ = pose.yaw_rad - 0.5 * std::numbers::pi;
    } else {
      const Eigen::Vector2d to_go(corner_x_m_ - pose.x_m, corner_y_m_ - pose.y_m);
      const bool late = now_s - since_s_ > side_s * side_steps();
      if (!late && to_go.dot(along(heading_rad_)) > 0.25 * step_m) return;
    }
    ++sides_;
    since_s_ = now_s;
    heading_rad_ = wrap_angle(heading_rad_ + 0.5 * std::numbers::pi);
    corner_x_m_ += side_steps() * step_m * std::cos(heading_rad_);
    corner_y_m_ += side_steps() * step_m * std::sin(heading_rad_);
  }
  [[nodiscard]] bool leads() const { return sides_ > 0; }
  /// [rad] direction from the head to the corner, in M.
  [[nodiscard]] double direction_rad(const msg::RobotPose& pose) const {
    return std::atan2(corner_y_m_ - pose.y_m, corner_x_m_ - pose.x_m);
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(sides_, corner_x_m_, corner_y_m_, heading_rad_, since_s_);
  }

 private:
  [[nodiscard]] int side_steps() const { return (sides_ + 1) / 2; }
  std::uint16_t sides_ = 0;                     // begun so far
  double corner_x_m_ = 0.0, corner_y_m_ = 0.0;  // the end of the present side
  double heading_rad_ = 0.0;                    // of the present side
  double since_s_ = 0.0;                        // when it began
};

}  // namespace constrictor
