// Whether the line is seen, debounced over images, and how far it lies to the side ahead.
#pragma once

#include <cstdint>

#include "constrictor/messages.hpp"

namespace constrictor {

struct LineWatchState {
  int seen = 0;               ///< images in a row in which the line was visible
  int missed = 0;             ///< images in a row in which it was not
  bool visible = false;       ///< debounced
  double offset_m = 0.0;      ///< of the newest image that showed it, at the lookahead asked for, positive left
  double heading_rad = 0.0;
  double end_distance_m = 1e9;  ///< to the line's end as last seen; large: not seen
  std::int64_t seen_tick = -1;  ///< exposure of the newest image that showed it
  int end_seen = 0;             ///< images in a row that showed the line's end
  template <class Archive>
  void serialize(Archive& archive) {
    archive(seen, missed, visible, offset_m, heading_rad, end_distance_m, seen_tick, end_seen);
  }
};

struct LineWatchLimits {
  int found_after = 3;         ///< images
  int lost_after = 10;         ///< images
  double lookahead_m = 0.35;
};

/// Takes a new percept of a line of `colour` (kColourUnknown: any). A percept of another colour counts as not visible.
void watch_line(const LineWatchLimits& limits, const msg::LinePercept& percept, std::uint8_t colour, LineWatchState& state);

/// Lateral offset [m] of a percept's line at x = lookahead, interpolated between its points; its nearest point's if the line does
/// not reach there; NaN if it is not visible.
double line_offset_m(const msg::LinePercept& percept, double lookahead_m);

}  // namespace constrictor
