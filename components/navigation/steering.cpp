#include "navigation/steering.hpp"

#include <cmath>

namespace constrictor {

void Steering::observe(double time_s, double error, double period_s, SteeringState& state) {
  if (std::isfinite(error)) state.samples.emplace_back(time_s, error);
  while (!state.samples.empty() && state.samples.front().first < time_s - period_s) state.samples.pop_front();
}

double Steering::mean_error(const SteeringState& state) {
  if (state.samples.empty()) return 0.0;
  double sum = 0.0;
  for (const auto& [time_s, error] : state.samples) sum += error;
  return sum / static_cast<double>(state.samples.size());
}

double Steering::curvature(double dt_s, SteeringState& state) const {
  if (state.samples.empty()) return pid_step(gains_, 0.0, dt_s, state.pid);
  return pid_step(gains_, mean_error(state), dt_s, state.pid);
}

}  // namespace constrictor
