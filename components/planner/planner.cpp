#include "planner/planner.hpp"

#include <algorithm>

#include "constrictor/text.hpp"

namespace constrictor {

Planner::Planner(Wiring& wiring, const Setup& setup)
    : config_(load_planner_config(setup.config_file, setup.mission)),
      planner_(config_, state_.mission),
      line_(wiring.latest(topics::kLinePercept)),
      objects_(wiring.latest(topics::kObjectPercepts)),
      pose_(wiring.latest(topics::kRobotPose)),
      map_(wiring.latest(topics::kFieldMap)),
      status_(wiring.latest(topics::kTaskStatus)),
      authority_(wiring.latest(topics::kAuthority)),
      events_(wiring.events(topics::kTaskEvent)),
      request_(wiring.output(topics::kPlannerRequest)),
      mission_(wiring.output(topics::kMissionStatus)) {}

void Planner::step(const Tick& tick) {
  PlannerInputs inputs;
  inputs.time_s = tick.time_s();
  if (line_) inputs.line = &*line_;
  if (objects_) inputs.objects = &*objects_;
  inputs.new_percepts = objects_.has_value() && objects_.fresh();
  if (pose_) inputs.pose = &*pose_;
  if (map_) inputs.map = &*map_;
  if (status_) inputs.status = &*status_;
  if (authority_) inputs.authority = &*authority_;
  for (const auto& event : events_) inputs.events.push_back(&event);
  if (const auto wanted = planner_.step(inputs)) {
    msg::Request request{};
    set_text(request.source, "planner");
    request.level = msg::kAuthorityPlanner;
    request.kind = msg::kRequestTask;
    request.goal_id = wanted->goal_id;
    request.command = wanted->command;
    request.task = wanted->task;
    request.parameters = wanted->parameters;
    request_.write(request);
  }
  const auto& memory = state_.mission;
  msg::MissionStatus mission{};
  mission.outcome = memory.state == MissionState::kDone     ? msg::kMissionSucceeded
                    : memory.state == MissionState::kFailed ? msg::kMissionFailed
                                                            : msg::kMissionRunning;
  set_text(mission.state, memory.suspended ? "suspended" : name_of(memory.state));
  mission.object_index = memory.object_index;
  mission.object_count = static_cast<std::uint16_t>(config_.sequence.size());
  mission.colour = planner_.colour();
  mission.recoveries = memory.recoveries;
  set_text(mission.reason, memory.reason);
  mission_.write(mission);
}

ComponentFactory make_planner_factory() {
  return {"planner", [](Wiring& wiring, const Setup& setup) { return std::make_unique<Planner>(wiring, setup); },
          "components/planner/planner.yaml", describe_parameters<PlannerConfig>};
}

}  // namespace constrictor
