// A PID controller as a pure function of its state.
#pragma once

namespace constrictor {

struct PidGains {
  double kp = 0.0;
  double ki = 0.0;                   ///< [1/s]
  double kd = 0.0;                   ///< [s]
  double limit = 1.0;                ///< bound of the magnitude of the output
  double derivative_filter_s = 0.2;  ///< time constant of the low-pass on the derivative; 0: none
};

struct PidState {
  double integral = 0.0;  ///< of the error [error s]
  double previous = 0.0;
  double derivative = 0.0;
  bool started = false;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(integral, previous, derivative, started);
  }
};

/// u = kp e + ki integral(e) + kd de/dt, within +- limit. While the output is at its limit, the integral does not grow
/// in that direction (conditional integration). A non-finite error counts as 0 and leaves the state unchanged. The
/// derivative is 0 at the first step.
double pid_step(const PidGains& gains, double error, double dt_s, PidState& state);

}  // namespace constrictor
