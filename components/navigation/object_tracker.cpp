#include "navigation/object_tracker.hpp"

#include <algorithm>
#include <cmath>

#include "robot/landmarks.hpp"

namespace constrictor {
namespace {

/// The object of this colour that counts, by the rules of take_places(). Null: there is none.
const msg::MapObject* object_of(const msg::FieldMap& map, std::uint8_t colour, const Eigen::Vector2d& p_MH,
                                std::uint16_t named, const Sighting& last) {
  // The map learns of an image later than the sighting does. What the image shows may also be too far away, or too
  // indistinct, for the map: then it says nothing about which landmark it is.
  constexpr std::int64_t kImagesBehind_ticks = 15;
  const msg::MapObject* best = nullptr;
  const auto shown = [&](const msg::MapObject& landmark) {
    return last.visible && landmark.last_seen_tick + kImagesBehind_ticks >= last.seen_tick;
  };
  const auto apart_m = [&](const msg::MapObject& landmark) {
    return (Eigen::Vector2d(landmark.x_m, landmark.y_m) - p_MH).norm();
  };
  const auto better = [&](const msg::MapObject& one, const msg::MapObject& other) {
    if (shown(one) != shown(other)) return shown(one);
    if (shown(one) && one.last_seen_tick != other.last_seen_tick) return one.last_seen_tick > other.last_seen_tick;
    if ((one.handle == named) != (other.handle == named)) return one.handle == named;
    if (!shown(one) && (one.handle == last.handle) != (other.handle == last.handle)) return one.handle == last.handle;
    return apart_m(one) < apart_m(other);
  };
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.colour != colour || landmark.kind != msg::kBlobObject || landmark.carried) continue;
    if (!best || better(landmark, *best)) best = &landmark;
  }
  return best;
}

void take_place(const msg::MapObject* landmark, double usual_radius_m, Range radius_m, Sighting& s) {
  s.known = landmark != nullptr;
  s.handle = landmark ? landmark->handle : std::uint16_t{0};
  if (!landmark) return;
  s.x_m = landmark->x_m;
  s.y_m = landmark->y_m;
  s.height_m = std::isfinite(landmark->height_m) ? landmark->height_m : 0.0;
  s.radius_m =
      std::isfinite(landmark->radius_m) ? std::clamp(landmark->radius_m, radius_m.min, radius_m.max) : usual_radius_m;
}

}  // namespace

void update_visibility(const ObjectTrackerConfig& config, const msg::ObjectPercepts& percepts,
                       ObjectTrackerState& state) {
  std::array<bool, msg::kColourCount> object{};
  std::array<bool, msg::kColourCount> zone{};
  for (Sighting& sighting : state.objects) sighting.decided = false;
  for (Sighting& sighting : state.zones) sighting.decided = false;
  for (std::size_t i = 0; i < percepts.blob_count; ++i) {
    const msg::Blob& blob = percepts.blobs[i];
    if (blob.colour >= msg::kColourCount) continue;
    const bool undecided = blob.kind == msg::kBlobUndecided;
    if (blob.kind == msg::kBlobObject) state.objects[blob.colour].decided = true;
    if (blob.kind == msg::kBlobZone) state.zones[blob.colour].decided = true;
    if (blob.kind == msg::kBlobObject || (undecided && state.objects[blob.colour].visible)) object[blob.colour] = true;
    if (blob.kind == msg::kBlobZone || (undecided && state.zones[blob.colour].visible)) zone[blob.colour] = true;
  }
  for (std::size_t colour = 0; colour < msg::kColourCount; ++colour) {
    debounce(config, object[colour], state.objects[colour]);
    debounce(config, zone[colour], state.zones[colour]);
    if (object[colour]) state.objects[colour].seen_tick = percepts.exposure_tick;
    if (zone[colour]) state.zones[colour].seen_tick = percepts.exposure_tick;
  }
}

void take_places(const ObjectTrackerConfig& config, const msg::FieldMap& map, const Eigen::Vector2d& p_MH,
                 std::uint16_t named, ObjectTrackerState& state) {
  for (std::uint8_t colour = 0; colour < msg::kColourCount; ++colour) {
    Sighting& object = state.objects[colour];
    take_place(object_of(map, colour, p_MH, named, object), config.object_radius_m,
               {config.min_radius_m, config.max_radius_m}, object);
    take_place(zone_of(map, colour), config.zone_radius_m, kZoneRadiusBounds_m, state.zones[colour]);
  }
}

}  // namespace constrictor
