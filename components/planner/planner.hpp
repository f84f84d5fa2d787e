// The built-in planner as a component: MissionPlanner on DDS topics.
#pragma once

#include "planner/mission_planner.hpp"
#include "runtime/component.hpp"

namespace constrictor {

struct PlannerState {
  MissionMemory mission;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(mission);
  }
};

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
