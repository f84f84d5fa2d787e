// Converts a speed and a turn rate, in which people and other systems command a vehicle, into a gait of the snake.
#pragma once

#include <algorithm>
#include <cmath>

namespace constrictor {

/// The parameters of the gait that a request for direct motion contains.
struct DriveGait {
  double frequency_hz = 0.0;   ///< frequency of the undulation; negative: backwards
  double curvature_1_m = 0.0;  ///< curvature of the path; positive: to the left
};

/// Returns the gait that moves the robot with about `speed_m_s` (negative: backwards) and `turn_rad_s` (positive: to
/// the left). Values that are not finite count as 0. With speed 0 the robot turns nearly on the spot. There is no
/// feedback: the true speed depends on the friction of the ground. Source: measured on the simulated Mamba with the
/// gait of components/navigation (0.7 Hz: about 0.7 m/s; curvature 2.25 1/m at 0.7 Hz: about 1.2 rad/s).
inline DriveGait drive_gait(double speed_m_s, double turn_rad_s) {
  constexpr double kMetresPerPeriod = 1.0;
  constexpr double kRotate_1_m = 2.25;  // curvature of a turn on the spot
  constexpr double kRotate_rad = 1.7;   // turn of the robot per period of a turn on the spot
  constexpr double kMost_hz = 1.0;
  constexpr double kMostDriving_1_m = 1.5;
  const double speed = std::isfinite(speed_m_s) ? speed_m_s : 0.0;
  const double turn = std::isfinite(turn_rad_s) ? turn_rad_s : 0.0;
  if (speed == 0.0 && turn == 0.0) return {};
  const double curvature = speed == 0.0 ? INFINITY : turn / speed;
  if (std::abs(curvature) > kMostDriving_1_m) {
    return {std::min(std::abs(turn) / kRotate_rad, kMost_hz), std::copysign(kRotate_1_m, turn)};
  }
  return {std::clamp(speed / kMetresPerPeriod, -kMost_hz, kMost_hz), curvature};
}

}  // namespace constrictor
