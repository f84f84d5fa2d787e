#include "navigation/pid.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {

double pid_step(const PidGains& gains, double error, double dt_s, PidState& state) {
  if (!std::isfinite(error) || dt_s <= 0.0) return std::clamp(gains.ki * state.integral, -gains.limit, gains.limit);
  if (state.started) {
    const double slope = (error - state.previous) / dt_s;
    const double share = gains.derivative_filter_s > 0.0 ? -std::expm1(-dt_s / gains.derivative_filter_s) : 1.0;
    state.derivative += share * (slope - state.derivative);
  }
  state.started = true;
  state.previous = error;
  const double proportional = gains.kp * error + gains.kd * state.derivative;
  const double integral = state.integral + error * dt_s;
  const double output = proportional + gains.ki * integral;
  // Do not integrate an error that pushes a saturated output further beyond its limit.
  const bool winds_up =
      (output > gains.limit && error * gains.ki > 0.0) || (output < -gains.limit && error * gains.ki < 0.0);
  if (!winds_up) state.integral = integral;
  return std::clamp(proportional + gains.ki * state.integral, -gains.limit, gains.limit);
}

}  // namespace constrictor
