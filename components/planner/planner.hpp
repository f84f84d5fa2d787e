// The built-in planner as a component: it connects MissionPlanner with its topics.
#pragma once

#include "component/component.hpp"
#include "component/object_bounds.hpp"
#include "component/robot_views.hpp"
#include "planner/delivery.hpp"
#include "planner/mission_planner.hpp"

namespace constrictor {

/// Reads percepts, pose, map, events, status and authority; writes a Request for each task and MissionStatus every
/// tick.
class Planner : public ConfiguredComponent<MissionMemory, PlannerConfig>, public ObjectJudge {
 public:
  Planner(Wiring& wiring, const Setup& setup);
  [[nodiscard]] bool has_short_steps() const override { return true; }
  void step(const Tick& tick) override;
  [[nodiscard]] CheckVerdict judge(const DemandedObject& object) const override { return judge_zone_size(object); }

 private:
  Log log_;
  MissionPlanner planner_;
  Latest<msg::TaskStatus> status_ = wiring_.latest(topics::kTaskStatus);
  Latest<msg::Authority> authority_ = wiring_.latest(topics::kAuthority);
  Events<msg::TaskEvent> events_ = wiring_.events(topics::kTaskEvent);
  FieldView field_{wiring_};
  Output<msg::Request> request_ = wiring_.output(topics::kPlannerRequest);
  Output<msg::MissionStatus> mission_ = wiring_.output(topics::kMissionStatus);
};

ComponentFactory make_planner_factory();

}  // namespace constrictor
