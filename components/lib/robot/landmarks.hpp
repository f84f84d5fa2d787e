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

/// The object with this handle; null: the map has none, or the handle is 0.
[[nodiscard]] inline const msg::MapObject* object_of_handle(const msg::FieldMap& map, std::uint16_t handle) {
  if (handle == 0) return nullptr;
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.kind == msg::kBlobObject && landmark.handle == handle) return &landmark;
  }
  return nullptr;
}

/// The object that the body holds; null: none.
[[nodiscard]] inline const msg::MapObject* carried_object(const msg::FieldMap& map) {
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.carried) return &landmark;
  }
  return nullptr;
}

/// [m] radius of the object or zone; `usual_radius_m` if no image has shown its whole width.
[[nodiscard]] inline double radius_or(const msg::MapObject& landmark, double usual_radius_m) {
  return std::isfinite(landmark.radius_m) ? landmark.radius_m : usual_radius_m;
}

/// [m] between a touched point and the surface of an object of this radius, at a distance from its centre.
[[nodiscard]] inline double surface_gap_m(double distance_m, double radius_m) {
  return std::abs(distance_m - radius_m);
}
/// [m] largest gap at which a touch may belong to an object whose place has this standard deviation.
[[nodiscard]] inline double touch_gate_m(double sd_m) { return 0.08 + 2.0 * sd_m; }

/// The object of the map that stands where the robot touches something, at a point of frame M; null: there is none, so
/// that it is an obstacle. An object of unknown radius has `usual_radius_m`.
[[nodiscard]] inline const msg::MapObject* touched_object(const msg::FieldMap& map, double x_m, double y_m,
                                                          double usual_radius_m) {
  const msg::MapObject* best = nullptr;
  double best_m = 0.0;
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.kind != msg::kBlobObject) continue;
    const double distance_m = std::hypot(landmark.x_m - x_m, landmark.y_m - y_m);
    const double gap_m = surface_gap_m(distance_m, radius_or(landmark, usual_radius_m));
    if (gap_m >= touch_gate_m(landmark.sd_m) || (best && gap_m >= best_m)) continue;
    best = &landmark;
    best_m = gap_m;
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
