// The built-in planner as a component: it connects MissionPlanner with its topics.
#pragma once

#include "component/component.hpp"
#include "planner/mission_planner.hpp"

namespace constrictor {

struct PlannerState {
  MissionMemory mission;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(mission);
  }
};

/// Reads percepts, pose, map, events, status and authority; writes a Request for each task and MissionStatus every
/// tick.
class Planner : public StatefulComponent<PlannerState> {
 public:
  Planner(Wiring& wiring, const Setup& setup);
  void step(const Tick& tick) override;

 private:
  PlannerConfig config_;
  MissionPlanner planner_;
  Latest<msg::LinePercept> line_;
  Latest<msg::ObjectPercepts> objects_;
  Latest<msg::RobotPose> pose_;
  Latest<msg::FieldMap> map_;
  Latest<msg::TaskStatus> status_;
  Latest<msg::Authority> authority_;
  Events<msg::TaskEvent> events_;
  Output<msg::Request> request_;
  Output<msg::MissionStatus> mission_;
};

ComponentFactory make_planner_factory();

}  // namespace constrictor
