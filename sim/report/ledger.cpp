#include "sim/report/ledger.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "constrictor/constants.hpp"

namespace constrictor::report {

ZoneVerdict judge_zone(const msg::SceneDescription& scene, const msg::WorldState& world, std::size_t object) {
  ZoneVerdict verdict{false, std::numeric_limits<double>::quiet_NaN(), 0.0};
  const msg::Vector3& p = world.object_poses[object].position_m;
  for (std::size_t i = 0; i < scene.zone_count; ++i) {
    const msg::SceneZone& zone = scene.zones[i];
    if (zone.colour != scene.objects[object].colour) continue;
    const double distance = std::hypot(p.x - zone.x_m, p.y - zone.y_m);
    if (!(distance >= verdict.distance_m)) {  // true for the first zone, whose distance is compared with NaN
      verdict = {distance <= zone.radius_m, distance, zone.radius_m};
    }
  }
  return verdict;
}

void ObjectLedger::start(const msg::SceneDescription& scene) { objects.resize(scene.object_count); }

void ObjectLedger::on_mission(const msg::MissionStatus& mission, bool carrying) {
  if (sequence.size() < mission.object_count) sequence.resize(mission.object_count, msg::kColourUnknown);
  if (mission.object_index < sequence.size() && mission.colour != msg::kColourUnknown)
    sequence[mission.object_index] = mission.colour;
  // A planner may look at an object or search for it without bringing it to a zone; this is no attempt. The status may
  // say that the robot carries an object before the event has told which one.
  if (!carrying || held < 0) return;
  // Nor does it change the order that an object is brought back which was pushed off its zone after it had been
  // dropped.
  if (objects[static_cast<std::size_t>(held)].dropped) return;
  const bool same = !attempted.empty() && attempted.back() == mission.object_index;
  if (mission.object_index >= sequence.size() || same) return;
  std::erase(attempted, mission.object_index);
  attempted.push_back(mission.object_index);
}

std::int32_t ObjectLedger::nearest(std::uint8_t colour, double reach_m, const msg::SceneDescription& scene,
                                   const msg::WorldState& world) const {
  std::int32_t found = -1;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (colour != msg::kColourUnknown && scene.objects[i].colour != colour) continue;
    const msg::Vector3& p = world.object_poses[i].position_m;
    const double object_radius_m = std::max(scene.objects[i].size_m.x, scene.objects[i].size_m.y) *
                                   (scene.objects[i].shape == msg::kShapeBox ? 0.5 : 1.0);
    for (std::size_t module = 0; module < world.module_count; ++module) {
      const msg::Vector3& q = world.module_poses[module].position_m;
      const double gap_m = std::hypot(p.x - q.x, p.y - q.y) - object_radius_m - scene.module_radius_m;
      if (gap_m <= reach_m && gap_m < least) {
        least = gap_m;
        found = static_cast<std::int32_t>(i);
      }
    }
  }
  return found;
}

void ObjectLedger::on_event(const msg::TaskEvent& event, const msg::SceneDescription& scene,
                            const msg::WorldState& world) {
  constexpr double kTouching_m = 0.05;
  if (event.event == msg::kEventObjectGrasped) {
    held = nearest(event.colour, kTouching_m, scene, world);
    if (held >= 0) objects[static_cast<std::size_t>(held)].grasped = true;
  } else if (event.event == msg::kEventObjectGraspLost) {
    held = -1;
  } else if (event.event == msg::kEventDroppingDone) {
    if (held >= 0) {
      ObjectRecord& record = objects[static_cast<std::size_t>(held)];
      if (!record.dropped) record.drop_tick = world.header.tick;
      record.dropped = true;
      record.by_others = event.goal_id >> 48 != msg::kAuthorityPlanner;
    }
    held = -1;
  }
}

std::vector<std::size_t> ObjectLedger::dropped() const {
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].dropped) indices.push_back(i);
  }
  std::sort(indices.begin(), indices.end(),
            [this](std::size_t a, std::size_t b) { return objects[a].drop_tick < objects[b].drop_tick; });
  return indices;
}

std::string ObjectLedger::shortfall(const msg::SceneDescription& scene, const msg::WorldState& world) const {
  std::vector<std::string> faults;
  const std::vector<std::size_t> dropped_objects = dropped();
  const auto colour_of = [&](std::size_t object) { return scene.objects[object].colour; };
  for (auto colour = sequence.begin(); colour != sequence.end(); ++colour) {
    // The n-th entry of a colour needs n dropped objects of that colour.
    const auto wanted = std::count(sequence.begin(), colour + 1, *colour);
    const auto found = std::count_if(dropped_objects.begin(), dropped_objects.end(),
                                     [&](std::size_t object) { return colour_of(object) == *colour; });
    if (*colour == msg::kColourUnknown || found >= wanted) continue;
    const bool grasped = held >= 0 && static_cast<std::size_t>(held) < objects.size() &&
                         colour_of(static_cast<std::size_t>(held)) == *colour;
    faults.push_back(std::string(name_of(constants::kColour, *colour)) +
                     (grasped ? " is grasped but not dropped" : " was not retrieved"));
  }
  if (faults.empty() && dropped_objects.size() != sequence.size()) {
    faults.push_back(
        fmt::format("{} objects were dropped, the mission has {}", dropped_objects.size(), sequence.size()));
  }
  std::vector<std::uint8_t> order;  // colours by their last attempts, then those that were never announced
  for (const std::uint16_t index : attempted) order.push_back(sequence[index]);
  for (std::size_t i = 0; i < sequence.size(); ++i) {
    if (std::find(attempted.begin(), attempted.end(), i) == attempted.end()) order.push_back(sequence[i]);
  }
  auto next = order.begin();
  for (const std::size_t object : dropped_objects) {
    const std::string colour = name_of(constants::kColour, colour_of(object));
    const ZoneVerdict verdict = judge_zone(scene, world, object);
    if (std::isnan(verdict.distance_m)) {
      faults.push_back("no zone has the colour " + colour);
    } else if (!verdict.in_zone) {
      faults.push_back(
          fmt::format("{} was believed delivered, but lies {:.2f} m from the centre of its zone (radius {:.2f} m)",
                      colour, verdict.distance_m, verdict.radius_m));
    }
    if (objects[object].by_others) continue;
    const auto place = std::find(next, order.end(), colour_of(object));
    if (place == order.end()) {
      faults.push_back(colour + " was dropped out of order");
    } else {
      next = place + 1;
    }
  }
  return fmt::format("{}", fmt::join(faults, "; "));
}

bool ObjectLedger::all_in_zones(const std::vector<std::uint8_t>& demanded, const msg::SceneDescription& scene,
                                const msg::WorldState& world) const {
  return std::all_of(demanded.begin(), demanded.end(), [&](std::uint8_t colour) {
    std::ptrdiff_t found = 0;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const bool counts = scene.objects[i].colour == colour && static_cast<std::int32_t>(i) != held;
      found += counts && judge_zone(scene, world, i).in_zone ? 1 : 0;
    }
    return found >= std::count(demanded.begin(), demanded.end(), colour);
  });
}

void BelievedLedger::on_event(const msg::TaskEvent& event) {
  if (event.event == msg::kEventObjectGrasped) {
    const auto same = std::find_if(objects.begin(), objects.end(), [&](const BelievedObject& one) {
      return one.colour == event.colour && !one.dropped;
    });
    held = static_cast<std::int32_t>(same - objects.begin());
    if (same == objects.end()) objects.push_back({event.colour, true, false});
  } else if (event.event == msg::kEventObjectGraspLost) {
    held = -1;
  } else if (event.event == msg::kEventDroppingDone) {
    if (held >= 0) objects[static_cast<std::size_t>(held)].dropped = true;
    held = -1;
  }
}

}  // namespace constrictor::report
