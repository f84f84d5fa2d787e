// A PID controller as a pure step function.
#pragma once

namespace constrictor {

struct PidGains {
  double kp = 0.0;
  double ki = 0.0;           ///< [1/s]
  double kd = 0.0;           ///< [s]
  double limit = 1.0;        ///< bound of the output's magnitude
  double derivative_filter_s = 0.2;  ///< time constant of the low-pass on the derivative; 0: none
};

struct PidState {
  double integral = 0.0;     ///< of the error [error s]
  double previous = 0.0;
  double derivative = 0.0;
  bool started = false;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(integral, previous, derivative, started);
  }
};

/// u = kp e + ki integral(e) + kd de/dt, within +- limit. While the output is at its limit the integral does not grow further in
/// that direction (conditional integration). A non-finite error is taken as 0 and leaves the state as it is; at the first step the
/// derivative is 0.
double pid_step(const PidGains& gains, double error, double dt_s, PidState& state);

}  // namespace constrictor
