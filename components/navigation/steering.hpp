// Steering: a PID controller from a cross-track error, averaged over a gait period, to the curvature of the path.
#pragma once

#include <cereal/types/deque.hpp>
#include <cereal/types/utility.hpp>
#include <deque>
#include <utility>

#include "navigation/pid.hpp"

namespace constrictor {

struct SteeringState {
  std::deque<std::pair<double, double>> samples;  ///< (time [s], error), oldest first
  PidState pid;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(samples, pid);
  }
};

/// Averages an error over one gait period, because the head sways with the gait, and computes a curvature from it.
class Steering {
 public:
  explicit Steering(const PidGains& gains) : gains_(gains) {}
  /// Adds an observation of the error and discards those older than `period_s`. A non-finite error is ignored.
  static void observe(double time_s, double error, double period_s, SteeringState& state);
  /// Mean of the observations; 0 without observations.
  [[nodiscard]] static double mean_error(const SteeringState& state);
  /// [1/m] curvature for the present mean error; advances the PID by `dt_s`.
  double curvature(double dt_s, SteeringState& state) const;

 private:
  PidGains gains_;
};

}  // namespace constrictor
