#include "navigation/line_tracker.hpp"

#include <cmath>
#include <limits>

namespace constrictor {

double line_offset_m(const msg::LinePercept& percept, double lookahead_m) {
  if (!percept.visible) return std::numeric_limits<double>::quiet_NaN();
  const int count = percept.point_count;
  for (int i = 0; i + 1 < count; ++i) {
    const double x0_m = percept.x_m[i];
    const double x1_m = percept.x_m[i + 1];
    if ((x0_m <= lookahead_m && lookahead_m < x1_m) || (x1_m <= lookahead_m && lookahead_m < x0_m)) {
      const double share = (lookahead_m - x0_m) / (x1_m - x0_m);
      return percept.y_m[i] + share * (percept.y_m[i + 1] - percept.y_m[i]);
    }
  }
  if (count == 0) return percept.offset_m;
  // The line does not reach the lookahead: its nearest point is moved there along its bearing.
  int nearest = 0;
  for (int i = 1; i < count; ++i) {
    if (std::abs(percept.x_m[i] - lookahead_m) < std::abs(percept.x_m[nearest] - lookahead_m)) nearest = i;
  }
  const double x_m = std::max(0.1, percept.x_m[nearest]);
  return percept.y_m[nearest] * lookahead_m / x_m;
}

void update_line_tracker(const LineTrackerConfig& config, const msg::LinePercept& percept, std::uint8_t colour,
                         LineTrackerState& state) {
  const bool wanted = colour == msg::kColourUnknown || percept.colour == colour;
  const double offset_m = line_offset_m(percept, config.lookahead_m);
  const bool shown = wanted && std::isfinite(offset_m);
  debounce(config, shown, state);
  if (shown) {
    state.offset_m = offset_m;
    if (std::isfinite(percept.heading_rad)) state.heading_rad = percept.heading_rad;
    if (std::isfinite(percept.curvature_1_m)) state.curvature_1_m = percept.curvature_1_m;
    state.seen_tick = percept.exposure_tick;
    if (percept.end_visible && std::isfinite(percept.end_distance_m)) {
      state.end_distance_m = percept.end_distance_m;
      ++state.end_seen;
    } else {
      state.end_distance_m = 1e9;
      state.end_seen = 0;
    }
  }
}

}  // namespace constrictor
