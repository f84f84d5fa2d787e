#include "planner/planner.hpp"

#include <algorithm>
#include <bit>

#include "constrictor/text.hpp"
#include "planner/short_text.hpp"

namespace constrictor {

Planner::Planner(Wiring& wiring, const Setup& setup)
    : ConfiguredComponent(wiring, load_planner_config(setup.config_file, setup.mission)),
      log_(setup.log),
      planner_(config_, state_) {}

void Planner::step(const Tick& tick) {
  PlannerInputs inputs;
  inputs.time_s = tick.time_s();
  inputs.tick = tick.index;
  inputs.line = field_.line.get();
  inputs.objects = field_.objects.get();
  inputs.new_percepts = field_.objects.has_value() && field_.objects.fresh();
  inputs.pose = field_.pose.get();
  inputs.map = field_.map.get();
  inputs.status = status_.get();
  inputs.authority = authority_.get();
  for (const auto& event : events_) inputs.events.push_back(&event);
  const std::string hindrance = state_.hindrance, reason = state_.reason;
  const auto wanted = planner_.step(inputs);
  if (state_.reason != reason) log_.warning("the mission has failed: {}", state_.reason);
  if (state_.hindrance != hindrance) {
    if (state_.hindrance.empty()) log_.info("the mission goes on in state {}", name_of(state_.state));
    else log_.warning("the mission {}", state_.hindrance);
  }
  if (wanted) {
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
  const MissionMemory& memory = state_;
  msg::MissionStatus mission{};
  mission.outcome = memory.state == MissionState::kDone     ? msg::kMissionSucceeded
                    : memory.state == MissionState::kFailed ? msg::kMissionFailed
                                                            : msg::kMissionRunning;
  set_text(mission.state, memory.suspended ? "suspended" : name_of(memory.state));
  mission.object_index = memory.object_index;
  mission.object_count = static_cast<std::uint16_t>(config_.sequence.size());
  mission.delivered_count = static_cast<std::uint16_t>(std::popcount(memory.delivered));
  mission.colour = planner_.colour();
  mission.recoveries = memory.recoveries;
  set_text(mission.reason,
           shortened(memory.reason.empty() ? memory.hindrance : memory.reason, sizeof mission.reason - 1));
  mission_.write(mission);
}

ComponentFactory make_planner_factory() {
  return make_factory<Planner, PlannerConfig>("planner", "components/planner/planner.yaml");
}

}  // namespace constrictor
