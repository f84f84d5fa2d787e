#include "planner/delivery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace constrictor {
namespace {

const msg::MapObject* find_object(std::span<const msg::MapObject> landmarks, std::uint8_t colour,
                                  std::uint16_t handle) {
  const msg::MapObject* newest = nullptr;
  for (const msg::MapObject& landmark : landmarks) {
    if (landmark.kind != msg::kBlobObject || landmark.colour != colour || landmark.carried) continue;
    if (handle != 0 && landmark.handle == handle) return &landmark;
    if (!newest || landmark.last_seen_tick > newest->last_seen_tick) newest = &landmark;
  }
  return newest;
}

const msg::MapObject* nearest_zone(std::span<const msg::MapObject> landmarks, const msg::MapObject& object,
                                   double& offset_m) {
  const msg::MapObject* zone = nullptr;
  for (const msg::MapObject& landmark : landmarks) {
    if (landmark.kind != msg::kBlobZone || landmark.colour != object.colour) continue;
    const double distance_m = std::hypot(landmark.x_m - object.x_m, landmark.y_m - object.y_m);
    if (zone && distance_m >= offset_m) continue;
    zone = &landmark;
    offset_m = distance_m;
  }
  return zone;
}

}  // namespace

DeliveryView view_delivery(const msg::FieldMap& map, std::uint8_t colour, std::uint16_t handle,
                           std::int64_t released_tick, double zone_radius_m) {
  // The release itself counts as a sighting of the carried object, and reaches the map some ticks later.
  constexpr std::int64_t kReleaseTicks = 25;
  const std::span landmarks(map.objects, std::min<std::size_t>(map.object_count, msg::kMaxMapObjects));
  DeliveryView view{Delivery::kUnseen, std::numeric_limits<double>::quiet_NaN(), zone_radius_m};
  const msg::MapObject* object = find_object(landmarks, colour, handle);
  if (!object) return view;
  const msg::MapObject* zone = nearest_zone(landmarks, *object, view.offset_m);
  if (!zone) return view;
  if (std::isfinite(zone->radius_m)) view.radius_m = zone->radius_m;
  if (object->last_seen_tick <= released_tick + kReleaseTicks) return view;
  const double sd_m = std::hypot(object->sd_m, zone->sd_m);
  view.verdict = view.offset_m + sd_m <= view.radius_m  ? Delivery::kOnZone
                 : view.offset_m - sd_m > view.radius_m ? Delivery::kOutside
                                                        : Delivery::kUncertain;
  return view;
}

}  // namespace constrictor
