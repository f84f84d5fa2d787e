// Who was held, dropped and where it lies now: the case study's outcome by ground truth.
#pragma once

#include <cereal/types/vector.hpp>
#include <cstdint>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::report {

struct ObjectRecord {
  bool grasped = false;
  bool dropped = false;
  std::int64_t drop_tick = -1;  ///< of the last drop
  bool by_others = false;       ///< an operator or external planner dropped it, not the built-in planner

  template <class Archive>
  void serialize(Archive& archive) { archive(grasped, dropped, drop_tick, by_others); }
};

/// Where an object lies relative to the zone of its colour.
struct ZoneVerdict {
  bool in_zone = false;
  double distance_m = 0.0;  ///< of its centre from the zone's centre; NaN if no zone has its colour
};
[[nodiscard]] ZoneVerdict judge_zone(const msg::SceneDescription& scene, const msg::WorldState& world, std::size_t object);

/// Follows the objects through the robot's events; ground truth says which object an event is about.
struct ObjectLedger {
  std::vector<ObjectRecord> objects;       ///< in the scene's order
  std::int32_t held = -1;                  ///< index of the object in the robot's grip; -1: none
  std::vector<std::uint8_t> sequence;      ///< colours in the mission's order; unknown where not heard of yet

  void start(const msg::SceneDescription& scene);
  void on_mission(const msg::MissionStatus& mission);
  /// A grasp counts only if an object of the colour touches the body, or nearly so.
  void on_event(const msg::TaskEvent& event, const msg::SceneDescription& scene, const msg::WorldState& world);
  /// Every object of the sequence was dropped and lies in the zone of its colour. Those that the built-in planner dropped were
  /// dropped in the sequence's order; an operator or external planner may have an order of its own.
  [[nodiscard]] bool complete(const msg::SceneDescription& scene, const msg::WorldState& world) const;

  template <class Archive>
  void serialize(Archive& archive) { archive(objects, held, sequence); }

 private:
  [[nodiscard]] std::int32_t nearest(std::uint8_t colour, double reach_m, const msg::SceneDescription& scene,
                                     const msg::WorldState& world) const;
};

}  // namespace constrictor::report
