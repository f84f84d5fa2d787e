// What swaying_control commands, and when it does not.
#pragma once

#include <cmath>
#include <cstdint>

namespace constrictor::testing {

inline constexpr std::size_t kSwayingJoint = 10;  ///< a yaw joint in the middle of the body
inline constexpr std::int64_t kFaultFrom = 200;   ///< [tick] first that is faulty
inline constexpr std::int64_t kFaultTo = 260;     ///< [tick] first that is not any more
inline constexpr double kSwayHalf_rad = 0.3;

/// Setpoint [rad] of the joint: between 0 and twice kSwayHalf_rad, once in two seconds.
inline double sway_rad(std::int64_t tick) {
  return kSwayHalf_rad * (1.0 - std::cos(M_PI * 0.02 * static_cast<double>(tick)));
}

}  // namespace constrictor::testing
