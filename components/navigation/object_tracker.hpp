// The object and the drop zone of each colour as navigation uses them: whether the images show them, debounced, and
// their places, which are those of the landmarks of guidance's map.
#pragma once

#include <array>
#include <cereal/types/array.hpp>
#include <cstdint>

#include "component/mission.hpp"
#include "constrictor/messages.hpp"
#include "navigation/debounce.hpp"
#include "robot/planar.hpp"

namespace constrictor {

/// The object, or the drop zone, of one colour.
struct Sighting : Visibility {
  bool decided = false;         ///< the newest image shows it, and no blob that may as well be something else
  std::int64_t seen_tick = -1;  ///< exposure of the newest image that showed it
  // The landmark of the map.
  bool known = false;        ///< the map has one
  std::uint16_t handle = 0;  ///< of the landmark; 0: the map has none
  double x_m = 0.0;          ///< centre in M
  double y_m = 0.0;
  double radius_m = 0.0;
  double height_m = 0.0;  ///< of an object; 0: unknown
  [[nodiscard]] Eigen::Vector2d p_M() const { return {x_m, y_m}; }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(seen, missed, visible, decided, seen_tick, known, handle, x_m, y_m, radius_m, height_m);
  }
};

struct ObjectTrackerConfig : DebounceConfig {
  ObjectTrackerConfig() : DebounceConfig("An object", 15) {}
  double object_radius_m = add(object_radius_m, "object_radius_m", kUsualObjectRadius_m, "m", kObjectRadiusBounds_m,
                               kAtStart, "Radius of an object until an image shows its whole width");
  double min_radius_m =
      add(min_radius_m, "min_radius_m", 0.03, "m", {0.0, 10.0}, kAtStart, "Smallest radius of an object");
  double max_radius_m = add(max_radius_m, "max_radius_m", kLargestObjectRadius_m, "m", {0.0, 10.0}, kAtStart,
                            "Largest radius of an object");
  double zone_radius_m = add(zone_radius_m, "zone_radius_m", kUsualZoneRadius_m, "m", kZoneRadiusBounds_m, kAtStart,
                             "Radius of a zone until an image shows its whole width");
};

struct ObjectTrackerState {
  std::array<Sighting, msg::kColourCount> objects;  ///< by colour
  std::array<Sighting, msg::kColourCount> zones;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(objects, zones);
  }
};

/// Takes a new set of percepts. An undecided blob counts for the object, and for the zone, of its colour that is
/// visible already.
void update_visibility(const ObjectTrackerConfig& config, const msg::ObjectPercepts& percepts,
                       ObjectTrackerState& state);

/// Takes the places from a new map. Of several objects of a colour that the newest image shows, the one with the handle
/// `named` counts (0: none is named), otherwise the one that is nearest to the head. While the images show none, or
/// one that is not in the map, the last one remains, until the map gives it up. An object that the robot carries is
/// none.
void take_places(const ObjectTrackerConfig& config, const msg::FieldMap& map, const Eigen::Vector2d& p_MH,
                 std::uint16_t named, ObjectTrackerState& state);

}  // namespace constrictor
