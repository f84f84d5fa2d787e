// Converts a speed and a turn rate, in which people and other systems command a vehicle, into a speed along a path and
// the curvature of the path.
#pragma once

#include <algorithm>
#include <cmath>

namespace constrictor {

/// The speed and the path that a request for direct motion contains.
struct DriveMotion {
  double speed_m_s = 0.0;      ///< along the path; negative: backwards
  double curvature_1_m = 0.0;  ///< of the path; positive: to the left
};

/// Returns a motion with about `speed_m_s` (negative: backwards), at most 0.9 m/s, and `turn_rad_s` (positive: to the
/// left). Values that are not finite count as 0. If the path would bend more than 1.5 1/m, also at speed 0, the speed
/// is ignored and the robot turns nearly on the spot. Source: measured on the simulated Mamba (curvature 2.25 1/m at
/// 0.63 m/s: about 1.2 rad/s, because the body also slides sideways).
inline DriveMotion drive_motion(double speed_m_s, double turn_rad_s) {
  constexpr double kRotate_1_m = 2.25;   // curvature of a turn on the spot
  constexpr double kRotate_rad_m = 1.9;  // turn of the robot per metre along this path
  constexpr double kMost_m_s = 0.9;
  constexpr double kMostDriving_1_m = 1.5;
  const double speed = std::isfinite(speed_m_s) ? speed_m_s : 0.0;
  const double turn = std::isfinite(turn_rad_s) ? turn_rad_s : 0.0;
  if (speed == 0.0 && turn == 0.0) return {};
  const double curvature = speed == 0.0 ? INFINITY : turn / speed;
  if (std::abs(curvature) > kMostDriving_1_m) {
    return {std::min(std::abs(turn) / kRotate_rad_m, kMost_m_s), std::copysign(kRotate_1_m, turn)};
  }
  return {std::clamp(speed, -kMost_m_s, kMost_m_s), curvature};
}

}  // namespace constrictor
