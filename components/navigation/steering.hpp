// From a cross-track error to the curvature of the undulation: a PI controller on the error averaged over a gait period.
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

/// Averages an error over one period of the gait, because the head sways with it, and turns it into a curvature.
class Steering {
 public:
  explicit Steering(const PidGains& gains) : gains_(gains) {}
  /// A new observation of the error. Observations older than `period_s` are forgotten. Non-finite ones are ignored.
  void observe(double time_s, double error, double period_s, SteeringState& state) const;
  /// Mean of the observations; 0 without any.
  [[nodiscard]] static double mean_error(const SteeringState& state);
  /// [1/m] curvature now.
  double curvature(double dt_s, SteeringState& state) const;

 private:
  PidGains gains_;
};

}  // namespace constrictor
