// The setpoints of the program swaying_control, and the ticks of its fault.
#pragma once

#include <cmath>
#include <cstdint>

namespace constrictor::testing {

inline constexpr std::size_t kSwayingJoint = 10;  ///< a yaw joint in the middle of the body
inline constexpr std::int64_t kFaultFrom = 200;   ///< the first tick with the fault
inline constexpr std::int64_t kFaultTo = 260;     ///< the first tick after the fault
inline constexpr double kSwayHalf_rad = 0.3;

/// Setpoint [rad] of the joint: it moves between 0 and twice kSwayHalf_rad with a period of 2 s.
inline double sway_rad(std::int64_t tick) {
  return kSwayHalf_rad * (1.0 - std::cos(M_PI * 0.02 * static_cast<double>(tick)));
}

}  // namespace constrictor::testing
