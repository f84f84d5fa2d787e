#include "sim/report/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace constrictor::report {

ZoneVerdict judge_zone(const msg::SceneDescription& scene, const msg::WorldState& world, std::size_t object) {
  ZoneVerdict verdict{false, std::numeric_limits<double>::quiet_NaN()};
  const msg::Vector3& p = world.object_poses[object].position_m;
  for (std::size_t i = 0; i < scene.zone_count; ++i) {
    const msg::SceneZone& zone = scene.zones[i];
    if (zone.colour != scene.objects[object].colour) continue;
    const double distance = std::hypot(p.x - zone.x_m, p.y - zone.y_m);
    if (!(distance >= verdict.distance_m)) {  // also the first one, compared with NaN
      verdict = {distance <= zone.radius_m, distance};
    }
  }
  return verdict;
}

void ObjectLedger::start(const msg::SceneDescription& scene) { objects.resize(scene.object_count); }

void ObjectLedger::on_mission(const msg::MissionStatus& mission) {
  if (sequence.size() < mission.object_count) sequence.resize(mission.object_count, msg::kColourUnknown);
  if (mission.object_index < sequence.size() && mission.colour != msg::kColourUnknown) sequence[mission.object_index] = mission.colour;
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

void ObjectLedger::on_event(const msg::TaskEvent& event, const msg::SceneDescription& scene, const msg::WorldState& world) {
  constexpr double kTouching_m = 0.05;
  if (event.event == msg::kEventObjectGrasped) {
    held = nearest(event.colour, kTouching_m, scene, world);
    if (held >= 0) objects[static_cast<std::size_t>(held)].grasped = true;
  } else if (event.event == msg::kEventObjectGraspLost) {
    held = -1;
  } else if (event.event == msg::kEventDroppingDone) {
    if (held >= 0) {
      objects[static_cast<std::size_t>(held)].dropped = true;
      objects[static_cast<std::size_t>(held)].drop_tick = world.header.tick;
      objects[static_cast<std::size_t>(held)].by_others = event.goal_id >> 48 != msg::kAuthorityPlanner;
    }
    held = -1;
  }
}

bool ObjectLedger::complete(const msg::SceneDescription& scene, const msg::WorldState& world) const {
  if (sequence.empty()) return false;
  std::vector<std::size_t> dropped;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].dropped) dropped.push_back(i);
  }
  std::sort(dropped.begin(), dropped.end(), [this](std::size_t a, std::size_t b) { return objects[a].drop_tick < objects[b].drop_tick; });
  if (dropped.size() != sequence.size()) return false;
  auto next = sequence.begin();
  for (const std::size_t object : dropped) {
    if (!judge_zone(scene, world, object).in_zone) return false;
    if (objects[object].by_others) continue;
    next = std::find(next, sequence.end(), scene.objects[object].colour);
    if (next == sequence.end()) return false;
    ++next;
  }
  return true;
}

}  // namespace constrictor::report
