#include "planner/delivery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "robot/landmarks.hpp"

namespace constrictor {
namespace {

// An image of the time before reaches the map some ticks later.
constexpr std::int64_t kLatencyTicks = 10;

bool may_be(const msg::MapObject& landmark, const DroppedObject& dropped) {
  if (landmark.kind != msg::kBlobObject || landmark.colour != dropped.colour || landmark.carried) return false;
  if (std::find(dropped.others.begin(), dropped.others.end(), landmark.handle) != dropped.others.end()) return false;
  const bool same = dropped.handle == 0 || landmark.handle == dropped.handle ||
                    landmark.handle > std::max(dropped.newest_handle, dropped.handle);
  return same && landmark.last_seen_tick > dropped.released_tick + kLatencyTicks;
}

/// The verdict if this landmark is the object.
DeliveryView view_of(const msg::FieldMap& map, const msg::MapObject& object, const DroppedObject& dropped,
                     double seen_sd_m, double zone_radius_m) {
  constexpr double kClearly = 3.0;  // standard deviations
  DeliveryView view{Delivery::kUnseen, false, std::numeric_limits<double>::quiet_NaN(), zone_radius_m, object.handle};
  const msg::MapObject* zone = zone_of(map, object.colour);
  if (!zone) return view;
  view.offset_m = std::hypot(zone->x_m - object.x_m, zone->y_m - object.y_m);
  if (std::isfinite(zone->radius_m)) view.radius_m = zone->radius_m;
  view.precise = object.sd_m <= seen_sd_m;
  view.sd_m = std::hypot(object.sd_m, zone->sd_m);
  const bool clearly_outside = view.offset_m - kClearly * view.sd_m > view.radius_m;
  view.verdict = dropped.may_have_moved && clearly_outside   ? Delivery::kOutside
                 : !view.precise                             ? Delivery::kUncertain
                 : view.probably_inside(view.sd_m)           ? Delivery::kOnZone
                 : view.offset_m - view.sd_m > view.radius_m ? Delivery::kOutside
                                                             : Delivery::kUncertain;
  return view;
}

}  // namespace

DeliveryView view_delivery(const msg::FieldMap& map, const DroppedObject& dropped, double seen_sd_m,
                           double zone_radius_m) {
  DeliveryView best{Delivery::kUnseen, false, std::numeric_limits<double>::quiet_NaN(), zone_radius_m};
  const msg::MapObject* best_object = nullptr;
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (!may_be(landmark, dropped)) continue;
    const DeliveryView view = view_of(map, landmark, dropped, seen_sd_m, zone_radius_m);
    const auto is_certain = [](const DeliveryView& one) {
      return one.verdict == Delivery::kOnZone || one.verdict == Delivery::kOutside;
    };
    const bool by_time = dropped.may_have_moved && best_object && is_certain(view) && is_certain(best);
    const bool better = !best_object ? true
                        : by_time    ? landmark.last_seen_tick > best_object->last_seen_tick
                                     : landmark.sd_m < best_object->sd_m;
    if (!better) continue;
    best = view;
    best_object = &landmark;
  }
  return best;
}

CheckVerdict judge_zone_size(const DemandedObject& object) {
  constexpr double kLeast_m = 0.06;  // kRim_m, and a standard deviation of the places of object and zone
  const double least_m = std::max(kLeast_m, object.radius_m());
  if (object.zone_key.empty() || object.zone_radius_m >= least_m) return {};
  const char* why = object.radius_m() > kLeast_m ? "the object hides a smaller zone"
                                                 : "the robot knows the places of object and zone no better";
  return {{fmt::format("{}.radius_m: found {:.3f} m, accepted at least {:.3f} m for {}: {}, and the robot cannot see "
                       "that the object was delivered",
                       object.zone_key, object.zone_radius_m, least_m, object.key, why)},
          {}};
}

bool all_on_zone(const msg::FieldMap& map, const DroppedObject& dropped, double seen_sd_m, double zone_radius_m) {
  std::size_t inside = 0;
  bool seen = false;
  for (const msg::MapObject& landmark : landmarks_of(map)) {
    if (landmark.kind != msg::kBlobObject || landmark.colour != dropped.colour || landmark.carried) continue;
    if (view_of(map, landmark, {}, seen_sd_m, zone_radius_m).verdict != Delivery::kOnZone) continue;
    ++inside;
    seen = seen || landmark.last_seen_tick > dropped.released_tick + kLatencyTicks;
  }
  return seen && inside > dropped.others.size();
}

std::uint16_t newest_handle(const msg::FieldMap& map) {
  std::uint16_t newest = 0;
  for (const msg::MapObject& landmark : landmarks_of(map)) newest = std::max(newest, landmark.handle);
  return newest;
}

}  // namespace constrictor
