// The outcome of the mission by ground truth: which objects were grasped and dropped, and where they lie.
#pragma once

#include <cereal/types/vector.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::report {

struct ObjectRecord {
  bool grasped = false;
  bool dropped = false;
  std::int64_t drop_tick = -1;  ///< tick of the first drop; -1: not dropped
  bool by_others = false;       ///< the goal that dropped it came from an operator or external planner

  template <class Archive>
  void serialize(Archive& archive) {
    archive(grasped, dropped, drop_tick, by_others);
  }
};

/// The place of an object relative to the nearest zone of its colour.
struct ZoneVerdict {
  bool in_zone = false;     ///< the centre of the object lies inside the zone
  double distance_m = 0.0;  ///< between the centres of object and zone; NaN if no zone has the object's colour
  double radius_m = 0.0;    ///< radius of the zone
};
[[nodiscard]] ZoneVerdict judge_zone(const msg::SceneDescription& scene, const msg::WorldState& world,
                                     std::size_t object);

/// Follows the objects through the events of the tasks. Ground truth decides which object an event is about.
struct ObjectLedger {
  std::vector<ObjectRecord> objects;   ///< in the order of the scene
  std::int32_t held = -1;              ///< index of the object in the robot's grip; -1: none
  std::vector<std::uint8_t> sequence;  ///< colours in the mission's order; kColourUnknown: not yet announced
  /// Indices of the sequence in the order in which they were last carried before they were dropped.
  std::vector<std::uint16_t> attempted;

  void start(const msg::SceneDescription& scene);
  /// `carrying`: the robot holds an object.
  void on_mission(const msg::MissionStatus& mission, bool carrying);
  /// A grasp counts only if an object of the event's colour is at most 0.05 m from the body.
  void on_event(const msg::TaskEvent& event, const msg::SceneDescription& scene, const msg::WorldState& world);
  /// The reasons, in words, why the mission is not complete; empty if it is complete. A mission is complete if every
  /// object of the sequence was dropped and lies in the zone of its colour. The objects that the built-in planner
  /// dropped must have been dropped for the first time in the order of the sequence, apart from those that it put
  /// aside and announced again later; an operator or an external planner may use another order.
  [[nodiscard]] std::string shortfall(const msg::SceneDescription& scene, const msg::WorldState& world) const;
  /// Whether as many objects of each colour as `demanded` names lie in zones of their colour, and not in the robot's
  /// grip. It does not matter who brought them there, nor in which order.
  [[nodiscard]] bool all_in_zones(const std::vector<std::uint8_t>& demanded, const msg::SceneDescription& scene,
                                  const msg::WorldState& world) const;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(objects, held, sequence, attempted);
  }

 private:
  /// Indices of the dropped objects in the order in which they were first dropped.
  [[nodiscard]] std::vector<std::size_t> dropped() const;
  /// Index of the object of this colour that is nearest to the robot's body, at most `reach_m` away; -1 if there is
  /// none.
  [[nodiscard]] std::int32_t nearest(std::uint8_t colour, double reach_m, const msg::SceneDescription& scene,
                                     const msg::WorldState& world) const;
};

/// The robot's estimate of what happened to an object: from the events of its tasks alone.
struct BelievedObject {
  std::uint8_t colour = msg::kColourUnknown;
  bool grasped = false;
  bool dropped = false;

  template <class Archive>
  void serialize(Archive& archive) {
    archive(colour, grasped, dropped);
  }
};

/// Follows the objects without ground truth. An object that was lost and grasped again is the same one.
struct BelievedLedger {
  std::vector<BelievedObject> objects;  ///< in the order in which they were grasped first
  std::int32_t held = -1;               ///< index of the object in the grip; -1: none

  void on_event(const msg::TaskEvent& event);

  template <class Archive>
  void serialize(Archive& archive) {
    archive(objects, held);
  }
};

}  // namespace constrictor::report
