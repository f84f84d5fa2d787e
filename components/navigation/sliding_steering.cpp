#include "navigation/sliding_steering.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {

void SlidingSteering::observe(double time_s, const LineAhead& line, double period_s, SlidingSteeringState& state) {
  const double heading_rad = line.heading_rad - line.curvature_1_m * line.ahead_m;
  const double offset_m =
      line.offset_m - line.ahead_m * std::tan(heading_rad) - 0.5 * line.curvature_1_m * line.ahead_m * line.ahead_m;
  if (!std::isfinite(offset_m)) return;
  Steering::observe(time_s, offset_m, period_s, state.offset);
  Steering::observe(time_s, heading_rad, period_s, state.heading);
  Steering::observe(time_s, line.curvature_1_m, period_s, state.curvature);
}

double SlidingSteering::curvature(const SlidingSteeringState& state) const {
  const double heading_rad = Steering::mean_error(state.heading);
  const double slope = Steering::mean_error(state.offset) / config_.approach_m;
  const double s = heading_rad + std::atan(slope);
  const double on_surface = std::sin(heading_rad) / config_.approach_m / (1.0 + slope * slope);
  const double towards = config_.gain_1_m * std::clamp(s / config_.layer_rad, -1.0, 1.0);
  return std::clamp(Steering::mean_error(state.curvature) + on_surface + towards, -limit_1_m_, limit_1_m_);
}

}  // namespace constrictor
