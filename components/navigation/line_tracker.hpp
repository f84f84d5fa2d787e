// The line as navigation sees it: visible or not, debounced over images, and its lateral offset ahead.
#pragma once

#include <cstdint>

#include "constrictor/messages.hpp"
#include "navigation/debounce.hpp"

namespace constrictor {

struct LineTrackerState : Visibility {
  double offset_m = 0.0;  ///< lateral offset at the lookahead in the newest image with the line, positive left
  double heading_rad = 0.0;
  double curvature_1_m = 0.0;
  double end_distance_m = 1e9;  ///< to the end of the line as last seen; 1e9: not seen
  std::int64_t seen_tick = -1;  ///< exposure of the newest image with the line
  int end_seen = 0;             ///< consecutive images that showed the end of the line
  template <class Archive>
  void serialize(Archive& archive) {
    archive(seen, missed, visible, offset_m, heading_rad, curvature_1_m, end_distance_m, seen_tick, end_seen);
  }
};

struct LineTrackerConfig : DebounceConfig {
  LineTrackerConfig() : DebounceConfig("The line", 10) {}
  double lookahead_m = add(lookahead_m, "lookahead_m", 0.35, "m", {0.1, 2.0}, kWhileRunning,
                           "Distance ahead of the head at which the offset of the line is taken");
};

/// Takes a new percept for the line of `colour` (kColourUnknown: any). A percept of another colour counts as an image
/// without the line.
void update_line_tracker(const LineTrackerConfig& config, const msg::LinePercept& percept, std::uint8_t colour,
                         LineTrackerState& state);

/// [m] lateral offset of the line at x = `lookahead_m`, interpolated between the points of the percept. If the line
/// does not reach that far, the offset is that of its nearest point, scaled to the same bearing. NaN: the line is not
/// visible.
double line_offset_m(const msg::LinePercept& percept, double lookahead_m);

}  // namespace constrictor
