// The landmarks of guidance's map.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Views of `map`, valid as long as it is.
[[nodiscard]] inline std::span<const msg::MapObject> landmarks_of(const msg::FieldMap& map) {
  return {map.objects, std::min<std::size_t>(map.object_count, msg::kMaxMapObjects)};
}

/// The landmark of this kind (msg::kBlob...) and colour (msg::kColour...) that is nearest to a point of frame M; null:
/// there is none.
[[nodiscard]] inline const msg::MapObject* nearest_landmark(const msg::FieldMap& map, std::uint8_t colour,
                                                            std::uint8_t kind, double x_m, double y_m) {
  const msg::MapObject* best = nullptr;
  double best_m = 0.0;
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.colour != colour || landmark.kind != kind) continue;
    const double distance_m = std::hypot(landmark.x_m - x_m, landmark.y_m - y_m);
    if (best && distance_m >= best_m) continue;
    best = &landmark;
    best_m = distance_m;
  }
  return best;
}

/// The zone of this colour; null: the map has none. There is one for each colour. If the map has several, the one whose
/// place is known best counts: the others may be something that looked like a zone once, such as an object that lies on
/// its side.
[[nodiscard]] inline const msg::MapObject* zone_of(const msg::FieldMap& map, std::uint8_t colour) {
  const msg::MapObject* best = nullptr;
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.colour != colour || landmark.kind != msg::kBlobZone) continue;
    if (!best || landmark.sd_m < best->sd_m) best = &landmark;
  }
  return best;
}

}  // namespace constrictor
