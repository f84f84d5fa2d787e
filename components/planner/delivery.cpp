#include "planner/delivery.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/landmarks.hpp"

namespace constrictor {
namespace {

// The release itself counts as a sighting of the carried object, and reaches the map some ticks later.
constexpr std::int64_t kReleaseTicks = 25;

/// The most precise landmark that may be the dropped object and was seen since; null: there is none.
const msg::MapObject* find_object(const msg::FieldMap& map, const DroppedObject& dropped) {
  const msg::MapObject* best = nullptr;
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.kind != msg::kBlobObject || landmark.colour != dropped.colour || landmark.carried) continue;
    const bool may_be = dropped.handle == 0 || landmark.handle == dropped.handle ||
                        landmark.handle > std::max(dropped.newest_handle, dropped.handle);
    if (!may_be || landmark.last_seen_tick <= dropped.released_tick + kReleaseTicks) continue;
    if (!best || landmark.sd_m < best->sd_m) best = &landmark;
  }
  return best;
}

}  // namespace

DeliveryView view_delivery(const msg::FieldMap& map, const DroppedObject& dropped, double seen_sd_m,
                           double zone_radius_m) {
  DeliveryView view{Delivery::kUnseen, false, std::numeric_limits<double>::quiet_NaN(), zone_radius_m};
  const msg::MapObject* object = find_object(map, dropped);
  if (!object) return view;
  const msg::MapObject* zone = nearest_landmark(map, object->colour, msg::kBlobZone, object->x_m, object->y_m);
  if (!zone) return view;
  view.offset_m = std::hypot(zone->x_m - object->x_m, zone->y_m - object->y_m);
  if (std::isfinite(zone->radius_m)) view.radius_m = zone->radius_m;
  view.precise = object->sd_m <= seen_sd_m;
  const double sd_m = std::hypot(object->sd_m, zone->sd_m);
  view.verdict = !view.precise                           ? Delivery::kUncertain
                 : view.offset_m + sd_m <= view.radius_m ? Delivery::kOnZone
                 : view.offset_m - sd_m > view.radius_m  ? Delivery::kOutside
                                                         : Delivery::kUncertain;
  return view;
}

std::uint16_t newest_handle(const msg::FieldMap& map) {
  std::uint16_t newest = 0;
  for (const msg::MapObject& landmark : landmarks_of(map)) newest = std::max(newest, landmark.handle);
  return newest;
}

}  // namespace constrictor
