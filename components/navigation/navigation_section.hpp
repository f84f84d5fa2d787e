// Parts that all groups of navigation's parameters use: bounds, and rows for speeds and PID controllers.
#pragma once

#include <string>

#include "configuration/parameter_set.hpp"
#include "navigation/pid.hpp"

namespace constrictor {

/// Bounds that several parameters share, in the unit of the parameter.
namespace bounds {
inline constexpr Range kLength{0.0, 10.0};
inline constexpr Range kAngle{0.0, 6.3};
inline constexpr Range kTime{0.0, 600.0};
inline constexpr Range kTorque{0.0, 20.0};
inline constexpr Range kForce{0.0, 100.0};
inline constexpr Range kSpeed{0.001, 2.0};
inline constexpr Range kCurvature{0.0, 5.0};
inline constexpr Range kShare{0.0, 1.0};
inline constexpr Range kCount{1, 20};
}  // namespace bounds

/// A group of navigation's parameters, with rows for speeds and PID controllers.
struct NavigationSection : ParameterSet {
  using ParameterSet::add;
  /// The desired speed of a motion along its path.
  double add_speed(double& speed_m_s, const std::string& key, double fallback_m_s, Changes changes,
                   const std::string& meaning) {
    return add(speed_m_s, key, fallback_m_s, "m/s", bounds::kSpeed, changes, meaning);
  }
  /// A PID controller from `error` to the curvature of the path.
  PidGains add(PidGains& gains, const std::string& key, const PidGains& fallback, Changes changes,
               const std::string& error) {
    const std::string meaning = "Curvature for the " + error + ": ";
    return {add(gains.kp, key + ".kp", fallback.kp, "", {0.0, 100.0}, changes, meaning + "proportional gain"),
            add(gains.ki, key + ".ki", fallback.ki, "1/s", {0.0, 100.0}, changes, meaning + "integral gain"),
            add(gains.kd, key + ".kd", fallback.kd, "s", {0.0, 100.0}, changes, meaning + "derivative gain"),
            add(gains.limit, key + ".limit_1_m", fallback.limit, "1/m", bounds::kCurvature, changes, meaning + "bound"),
            add(gains.derivative_filter_s, key + ".derivative_filter_s", fallback.derivative_filter_s, "s",
                bounds::kTime, kAtStart, meaning + "time constant of the derivative's low-pass; 0: none")};
  }
};

}  // namespace constrictor
