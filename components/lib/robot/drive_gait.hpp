// Speed and turn rate, as people and other systems think of driving, to the undulation that does about that.
#pragma once

#include <algorithm>
#include <cmath>

namespace constrictor {

/// What a direct motion takes.
struct DriveGait {
  double frequency_hz = 0.0;   ///< negative: backwards
  double curvature_1_m = 0.0;  ///< positive left
};

/// The undulation for about `speed_m_s` (negative: backwards) and `turn_rad_s` (positive: the head turns left). Not
/// finite counts as 0. Without speed it turns nearly on the spot. It is open loop: the ground's friction decides how
/// fast the robot really is. Source: measured on the simulated Mamba with the gait of components/navigation (0.7 Hz:
/// about 0.7 m/s; curvature 2.25 1/m at 0.7 Hz: about 1.2 rad/s).
inline DriveGait drive_gait(double speed_m_s, double turn_rad_s) {
  constexpr double kMetresPerPeriod = 1.0;
  constexpr double kRotate_1_m = 2.25;
  constexpr double kRotate_rad = 1.7;  // per period
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
