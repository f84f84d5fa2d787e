// How the mission planner decides whether an object is delivered, and what it does after failures with an object.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "constrictor/constants.hpp"
#include "planner/mission_planner.hpp"
#include "robot/landmarks.hpp"

namespace constrictor {

using enum MissionState;

DeliveryView MissionPlanner::dropped_object(const PlannerInputs& inputs) const {
  if (!inputs.map) return {};
  const DroppedObject dropped{colour(), memory_.dropped_handle,     memory_.newest_handle, memory_.released_tick,
                              false,    twins(memory_.object_index)};
  DeliveryView view = view_delivery(*inputs.map, dropped, config_.seen_sd_m, config_.zone_radius_m);
  const bool unseen = view.verdict == Delivery::kUnseen && !dropped.others.empty();
  if (unseen && all_on_zone(*inputs.map, dropped, config_.seen_sd_m, config_.zone_radius_m))
    view.verdict = Delivery::kOnZone;
  return view;
}

std::vector<std::uint16_t> MissionPlanner::twins(std::uint16_t index) const {
  std::vector<std::uint16_t> handles;
  if (index >= config_.sequence.size()) return handles;
  for (const PlacedObject& object : memory_.placed) {
    const bool alike = config_.sequence.at(object.index) == config_.sequence.at(index);
    if (alike && object.index != index && object.handle != 0) handles.push_back(object.handle);
  }
  return handles;
}

bool MissionPlanner::has_delivered_twin() const {
  for (std::size_t i = 0; i < config_.sequence.size(); ++i) {
    if (i != memory_.object_index && config_.sequence[i] == colour() && done(i)) return true;
  }
  return false;
}

void MissionPlanner::note_drops(const PlannerInputs& inputs) {
  for (const auto* event : inputs.events) {
    if (event->event != msg::kEventDroppingDone) continue;
    if (event->goal_id >> 48 == msg::kAuthorityPlanner) {
      memory_.dropped = true;
      memory_.rechecked = 0;
      memory_.dropped_handle = event->object_handle;
      continue;
    }
    note_drop_by_others(*event, inputs);
  }
}

void MissionPlanner::note_drop_by_others(const msg::TaskEvent& event, const PlannerInputs& inputs) {
  memory_.rechecked = 0;
  const auto again = std::find_if(memory_.placed.begin(), memory_.placed.end(), [&](const PlacedObject& object) {
    return event.object_handle != 0 && object.handle == event.object_handle;
  });
  PlacedObject dropped{0, event.object_handle, memory_.newest_carried, inputs.tick, 0.0, false, true};
  if (again != memory_.placed.end()) {
    dropped.index = again->index;
    *again = dropped;
    return;
  }
  std::size_t i = 0;
  while (i < config_.sequence.size() && (config_.sequence[i] != event.colour || done(i))) ++i;
  if (i == config_.sequence.size()) return;
  dropped.index = static_cast<std::uint16_t>(i);
  memory_.placed.push_back(dropped);
  memory_.delivered |= std::uint32_t{1} << i;
  if (i == memory_.object_index) memory_.dropped = false;  // the planner's own drop of it does not count any more
}

MissionState MissionPlanner::after_drop(const PlannerInputs& inputs) {
  switch (dropped_object(inputs).verdict) {
    case Delivery::kOnZone: {
      // After the last object the robot looks a little longer: it may have pushed the others off their zones.
      const bool looked = memory_.state == kInspect && memory_.active_s - memory_.entered_s >= config_.last_look_s;
      return at_last_object() && !looked ? kInspect : delivered(inputs);
    }
    case Delivery::kOutside:
      return recover(kSearchObject, "it was seen outside its zone");
    default:
      return kInspect;
  }
}

MissionState MissionPlanner::after_inspection(bool in_view, const PlannerInputs& inputs) {
  const DeliveryView view = dropped_object(inputs);
  // The search has found the object, but no image has shown it to the map yet.
  constexpr std::uint8_t kMostStepBacks = 2;  // stepping back again and again would show the same
  const bool goes_on = memory_.active_s - memory_.entered_s < config_.inspect_s && memory_.step_backs < kMostStepBacks;
  if (in_view && goes_on && view.verdict == Delivery::kUnseen) {
    ++memory_.vain_looks;
    return kInspect;
  }
  // An object whose place is imprecise must look farther from the border: a search brings it into the middle of the
  // image. A larger share would never be satisfied after an operator has driven the robot: all places are then
  // imprecise, although the error is the same for object and zone.
  constexpr double kDoubt = 0.25;  // of the standard deviation
  const bool seen = in_view || view.precise;
  const double doubt_m = view.precise ? 0.0 : kDoubt * view.sd_m;
  const bool likely = seen && view.verdict == Delivery::kUncertain && view.probably_inside(doubt_m);
  return likely || view.verdict == Delivery::kOnZone ? delivered(inputs)
                                                     : recover(kSearchObject, "it was not seen on its zone");
}

MissionState MissionPlanner::delivered(const PlannerInputs& inputs) {
  memory_.delivered |= std::uint32_t{1} << memory_.object_index;
  memory_.displaced &= ~memory_.delivered;
  const std::uint16_t newest = inputs.map ? newest_handle(*inputs.map) : std::uint16_t{0};
  const std::uint16_t seen = dropped_object(inputs).handle;  // the map may have given the object a new handle
  const std::uint16_t handle = seen != 0 ? seen : memory_.dropped_handle;
  memory_.placed.push_back({memory_.object_index, handle, newest, inputs.tick, 0.0, false, false});
  memory_.dropped = false;
  memory_.released_tick = -1;
  const std::uint16_t last = memory_.object_index;
  if (inspect_unseen()) return kInspect;
  if (!choose_object()) return inspect_doubtful(inputs, last) ? kInspect : end_of_sequence();
  // An object that the robot has pushed off its zone is near.
  return (memory_.displaced >> memory_.object_index & 1u) != 0 ? kSearchObject : kTurnRound;
}

bool MissionPlanner::at_last_object() const {
  for (std::size_t i = 0; i < config_.sequence.size(); ++i) {
    if (i != memory_.object_index && !done(i)) return false;
  }
  return config_.sequence.size() > 1;
}

void MissionPlanner::watch_placed_objects(const PlannerInputs& inputs, double elapsed_s) {
  constexpr double kNoticed_s = 0.4;
  const auto touched_since = [&](const PlacedObject& object) {
    if (!inputs.map || object.handle == 0) return false;
    const auto count = std::min<std::size_t>(inputs.map->touch_count, msg::kMaxTouches);
    return std::any_of(inputs.map->touches, inputs.map->touches + count, [&](const msg::TouchPoint& touch) {
      return touch.handle == object.handle && touch.tick > object.tick;
    });
  };
  for (PlacedObject& object : memory_.placed) object.touched = object.touched || touched_since(object);
  const auto off_zone = [&](PlacedObject& object) {
    if (object.unseen) return false;  // the planner will look
    const bool outside = placed_object(object, inputs).verdict == Delivery::kOutside;
    object.outside_s = outside ? object.outside_s + elapsed_s : 0.0;
    return object.outside_s > kNoticed_s;
  };
  const auto gone = std::find_if(memory_.placed.begin(), memory_.placed.end(), off_zone);
  if (gone != memory_.placed.end()) take_back(gone);
}

DeliveryView MissionPlanner::placed_object(const PlacedObject& object, const PlannerInputs& inputs,
                                           bool any_distance) const {
  constexpr double kNear_m = 1.6;  // an unknown object of this colour that is farther from the zone may be another one
  const std::uint8_t colour = config_.sequence[object.index];
  bool all = true;  // all objects of this colour are delivered: an object that appears now is one of them
  for (std::size_t i = 0; i < config_.sequence.size(); ++i) all = all && (config_.sequence[i] != colour || done(i));
  constexpr std::uint16_t kNoOther = std::numeric_limits<std::uint16_t>::max();
  const auto alike = std::count(config_.sequence.begin(), config_.sequence.end(), colour);
  if (!inputs.map || (object.handle == 0 && (!all || alike > 1))) return {};
  const DroppedObject dropped{colour,      object.handle, all ? object.newest_handle : kNoOther,
                              object.tick, true,          twins(object.index)};
  const auto view = view_delivery(*inputs.map, dropped, config_.seen_sd_m, config_.zone_radius_m);
  const bool known = object_of_handle(*inputs.map, object.handle) != nullptr;
  // An object that images no longer show on its zone has gone, and what has appeared elsewhere is it.
  const bool own = view.handle != 0 && (view.handle == object.handle || !known);
  return own || any_distance || view.offset_m < kNear_m ? view : DeliveryView{};
}

bool MissionPlanner::inspect_doubtful(const PlannerInputs& inputs, std::uint16_t except) {
  const auto doubtful = [&](const PlacedObject& object) {
    if (object.index == except || (memory_.rechecked >> object.index & 1u) != 0 || !inputs.map) return false;
    // Without a handle, another object of its colour may be taken for it: a look proves nothing.
    const auto alike = std::count(config_.sequence.begin(), config_.sequence.end(), config_.sequence[object.index]);
    if (alike > 1 && object.handle == 0) return false;
    const msg::MapObject* landmark = object_of_handle(*inputs.map, object.handle);
    const bool touched = object.touched || (landmark && landmark->sd_m > config_.seen_sd_m);
    const Delivery verdict = placed_object(object, inputs, true).verdict;
    return touched || verdict == Delivery::kOutside || verdict == Delivery::kUncertain;
  };
  const auto found = std::find_if(memory_.placed.begin(), memory_.placed.end(), doubtful);
  if (found == memory_.placed.end()) return false;
  memory_.rechecked |= std::uint32_t{1} << found->index;
  look_at(found, inputs.tick);
  return true;
}

bool MissionPlanner::inspect_unseen() {
  const auto found = std::find_if(memory_.placed.begin(), memory_.placed.end(),
                                  [](const PlacedObject& object) { return object.unseen; });
  if (found == memory_.placed.end()) return false;
  look_at(found, found->tick);
  return true;
}

void MissionPlanner::look_at(PlacedObjects::iterator object, std::int64_t since_tick) {
  memory_.delivered &= ~(std::uint32_t{1} << object->index);
  memory_.object_index = object->index;
  memory_.dropped = true;
  memory_.dropped_handle = object->handle;
  memory_.newest_handle = object->newest_handle;
  memory_.released_tick = since_tick;
  memory_.placed.erase(object);
  memory_.entered_s = memory_.active_s;
  memory_.vain_looks = memory_.step_backs = 0;
  memory_.requested = false;
}

bool MissionPlanner::inspects_by_handle(const PlannerInputs& inputs) const {
  if ((memory_.rechecked >> memory_.object_index & 1u) == 0 || !inputs.map) return false;
  return object_of_handle(*inputs.map, memory_.dropped_handle) != nullptr;
}

void MissionPlanner::take_back(PlacedObjects::iterator gone) {
  memory_.delivered &= ~(std::uint32_t{1} << gone->index);
  memory_.displaced |= std::uint32_t{1} << gone->index;
  // What was tried with the object counts on: an object that is pushed off again and again is put aside in the end.
  if (!may_try_again(attempts(gone->index), "delivered", "it was pushed off its zone"))
    memory_.aside |= std::uint32_t{1} << gone->index;
  memory_.placed.erase(gone);
  ++memory_.recoveries;
}

bool MissionPlanner::choose_object() {
  const auto next_open = [this] {
    std::size_t i = 0;
    while (i < config_.sequence.size() && ((memory_.delivered | memory_.aside) >> i & 1u) != 0) ++i;
    return i;
  };
  std::size_t next = next_open();
  const bool any_aside = (memory_.aside & ~memory_.delivered) != 0;
  if (next == config_.sequence.size() && any_aside && !memory_.second_pass) {
    memory_.second_pass = true;
    memory_.aside = 0;
    next = next_open();
  }
  memory_.object_index = static_cast<std::uint16_t>(next);
  return next < config_.sequence.size();
}

std::string MissionPlanner::not_delivered() const {
  std::string left;
  for (std::size_t i = 0; i < config_.sequence.size(); ++i) {
    if (done(i)) continue;
    left += (left.empty() ? "" : "; ") + std::string(name_of(constants::kColour, config_.sequence[i]));
    if (i >= memory_.attempts.size() || memory_.attempts[i].failures == 0) continue;
    const Attempts& tried = memory_.attempts[i];
    left += fmt::format(" ({} attempts failed, the last in {})", tried.failures, tried.reason);
  }
  return left;
}

MissionState MissionPlanner::end_of_sequence() {
  const std::string left = not_delivered();
  return left.empty() ? kDone : fail("not delivered: " + left);
}

bool MissionPlanner::may_try_again(Attempts& tried, const char* state, const std::string& why) const {
  ++tried.failures;
  tried.reason = fmt::format("{}: {}", state, why);
  return tried.failures < config_.attempts + (memory_.second_pass ? 1 : 0);
}

MissionState MissionPlanner::put_aside() {
  memory_.aside |= std::uint32_t{1} << memory_.object_index;
  memory_.released_tick = -1;
  if (inspect_unseen()) return kInspect;
  return choose_object() ? kSearchLineOrObject : end_of_sequence();
}

MissionState MissionPlanner::try_differently(const std::string& why) {
  Attempts& tried = attempts();
  const bool again = may_try_again(tried, name_of(memory_.state), why);
  memory_.dropped = false;
  if (again) return tried.failures > 1 ? kApproachAnew : kSearchObject;
  return put_aside();
}

// Where zones may be anywhere, so may the other objects: the robot first looks at the other end of the line.
MissionState MissionPlanner::search_elsewhere(const std::string& why) {
  if (config_.sequence.empty()) return kSearchLineOrObject;
  const bool again = may_try_again(attempts(), name_of(memory_.state), why);
  bool others = false;
  for (std::size_t i = 0; i < config_.sequence.size(); ++i) {
    const bool open = !done(i) && (!memory_.second_pass || (memory_.aside >> i & 1u) == 0);
    others = others || (open && i != memory_.object_index);
  }
  const bool here = config_.zones_at != kZonesAnywhere;
  return again && !(others && here) ? kSearchLineOrObject : put_aside();
}

}  // namespace constrictor
