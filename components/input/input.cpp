#include "input/input.hpp"

#include <algorithm>

namespace constrictor {
namespace {
constexpr std::int64_t kAuthorityInterval_ticks = 50;
}

Input::Input(Wiring& wiring, const Setup&)
    : planner_requests_(wiring.events(topics::kPlannerRequest)),
      command_(wiring.output(topics::kTaskCommand)),
      authority_(wiring.output(topics::kAuthority)) {}

void Input::step(const Tick& tick) {
  commands_left_ = topics::kTaskCommand.max_per_tick;
  bool changed = false;
  for (const auto& request : planner_requests_) changed = rule(request) || changed;
  const bool due = state_.last_authority_tick < 0 || tick.index - state_.last_authority_tick >= kAuthorityInterval_ticks;
  if (changed || due) publish_authority(tick);
}

bool Input::rule(const msg::Request& request) {
  const std::string holder_before = state_.arbiter.holder;
  const std::uint64_t refused_before = state_.arbiter.refused;
  const bool stopped_before = state_.arbiter.stopped;
  Arbiter arbiter(state_.arbiter);
  const Ruling ruling = arbiter.decide(request);
  if (ruling.kind == Ruling::kForward) {
    if (commands_left_ == 0) {
      ++state_.arbiter.refused;
      state_.arbiter.refusal = "more than " + std::to_string(topics::kTaskCommand.max_per_tick) + " task commands in a tick";
      return true;
    }
    --commands_left_;
    msg::TaskCommand command{};
    command.goal_id = arbiter.goal_id(request);
    command.command = request.command;
    command.task = request.task;
    command.parameters = request.parameters;
    command_.write(command);
    state_.running_goal = command.goal_id;
    state_.running_task = request.task;
  } else if (ruling.kind == Ruling::kCancelAll) {
    cancel_running();
  }
  return state_.arbiter.holder != holder_before || state_.arbiter.refused != refused_before ||
         state_.arbiter.stopped != stopped_before || ruling.kind == Ruling::kForward;
}

void Input::cancel_running() {
  if (state_.running_goal == 0 || commands_left_ == 0) return;
  --commands_left_;
  msg::TaskCommand command{};
  command.goal_id = state_.running_goal;
  command.command = msg::kCommandCancel;
  command.task = state_.running_task;
  command_.write(command);
}

void Input::publish_authority(const Tick& tick) {
  state_.last_authority_tick = tick.index;
  const auto set = [](auto& field, const std::string& text) {
    const std::size_t length = std::min(text.size(), std::size(field) - 1);
    std::copy_n(text.begin(), length, field);
  };
  msg::Authority authority{};
  authority.level = state_.arbiter.stopped ? msg::kAuthorityStop : state_.arbiter.level;
  set(authority.source, state_.arbiter.stopped ? state_.arbiter.stopper : state_.arbiter.holder);
  authority.goal_id = state_.running_goal;
  authority.refused_count = state_.arbiter.refused;
  set(authority.refusal, state_.arbiter.refusal);
  authority.emergency_stop = state_.arbiter.stopped;
  authority_.write(authority);
}

ComponentFactory make_input_factory() {
  return {"input", [](Wiring& wiring, const Setup& setup) { return std::make_unique<Input>(wiring, setup); }};
}

}  // namespace constrictor
