#include "input/input.hpp"

#include <algorithm>
#include <utility>

#include "constrictor/text.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kAuthorityInterval_ticks = 50;
constexpr std::int64_t kStale_ticks = 50;

}  // namespace

Input::Input(Wiring& wiring, const Setup& setup, std::shared_ptr<ClientRequests> client_requests)
    : wiring_(wiring),
      parameters_in_{wiring.latest(topics::kNavigationParameters), wiring.latest(topics::kControlParameters),
                     wiring.latest(topics::kPerceptionParameters), wiring.latest(topics::kGuidanceParameters)},
      planned_(load_planned_changes(setup.config_file)),
      client_requests_(client_requests ? std::move(client_requests) : wiring.client_requests()) {}

void Input::step(const Tick& tick) {
  commands_left_ = topics::kTaskCommand.max_per_tick;
  changes_left_ = topics::kParameterChange.max_per_tick;
  now_ = tick.index;
  motion_.reset();
  Arbiter arbiter(state_.arbiter);
  const std::uint8_t level_before = state_.arbiter.level;
  const std::string holder_before = state_.arbiter.holder;
  const bool stopped_before = state_.arbiter.stopped;
  bool changed = set_planned_parameters(tick);
  const bool plant_stopped = follow_plant_stop();
  if (client_requests_) {
    for (const auto& item : client_requests_->latch(arbiter.living())) {
      changed = true;
      if (!item.refusal.empty()) {
        answer(item.request, [&] { return arbiter.refuse(item.request, item.refusal); });
        state_.arbiter.refused += item.times - 1;
        continue;
      }
      const bool another = item.writer != WriterId{} && arbiter.has_another_writer(item.source, item.writer);
      // A source that sends through another writer is another process, and the former process of its name is dead. A
      // death that is reported after that belongs to the former process.
      if (item.died != another) obey(arbiter.on_death(item.source), item.request);
      if (!item.died) answer(item.request, [&] { return arbiter.decide_client(item.request, item.writer); });
    }
  }
  for (const auto& request : planner_requests_) {
    const std::int64_t age_ticks = tick.index - request.header.tick;
    changed = true;
    answer(request, [&] {
      if (age_ticks <= kStale_ticks) return arbiter.decide_planner(request);
      return arbiter.refuse(request, "request of planner: found " + std::to_string(age_ticks) +
                                         " ticks old, accepted " + std::to_string(kStale_ticks));
    });
  }
  // A request to clear a stop that was sent before this stop of the plant must not clear it.
  if (plant_stopped) obey(arbiter.stop(text_of(plant_stop_->source)), {});
  clear_plant_stop();
  if (motion_) motion_out_.write(*motion_);
  changed = changed || state_.arbiter.level != level_before || state_.arbiter.holder != holder_before ||
            state_.arbiter.stopped != stopped_before;
  const bool due =
      state_.last_authority_tick < 0 || tick.index - state_.last_authority_tick >= kAuthorityInterval_ticks;
  if (changed || due) publish_authority(tick);
}

template <class Decide>
void Input::answer(const msg::Request& request, Decide&& decide) {
  const std::uint64_t refused_before = state_.arbiter.refused;
  const Decision decision = decide();
  obey(decision, request);  // may refuse for reasons that the arbiter does not know
  msg::RequestAnswer answer{};
  set_text(answer.source, state_.arbiter.answered_source);
  answer.request_sequence = request.header.sequence_number;
  answer.granted = decision.kind == Decision::kRepeated ? decision.granted : state_.arbiter.refused == refused_before;
  if (answer.granted) answer.goal_id = decision.goal_id;
  else
    set_text(answer.reason,
             decision.kind == Decision::kRepeated ? "this request was refused before" : state_.arbiter.refusal);
  if (answer.granted && request.kind == msg::kRequestClearStop) clearer_ = state_.arbiter.answered_source;
  answer_out_.write(answer);
}

bool Input::follow_plant_stop() {
  if (!plant_stop_ || plant_stop_->number <= state_.plant_stops) return false;
  state_.plant_stops = plant_stop_->number;
  obey(Arbiter(state_.arbiter).stop(text_of(plant_stop_->source)), {});
  return true;
}

void Input::clear_plant_stop() {
  if (state_.arbiter.stopped || state_.cleared_stops == state_.plant_stops) return;
  state_.cleared_stops = state_.plant_stops;
  msg::StopCleared cleared{};
  cleared.number = state_.plant_stops;
  set_text(cleared.source, clearer_);
  stop_cleared_.write(cleared);
}

void Input::obey(const Decision& decision, const msg::Request& request) {
  switch (decision.kind) {
    case Decision::kNothing:
    case Decision::kRepeated:
    case Decision::kRefused:
      break;
    case Decision::kCancelAll:
      cancel_running();
      break;
    case Decision::kMove:
      forward_motion(request);
      break;
    case Decision::kSet:
      set_parameter(request);
      break;
    case Decision::kForward:
      forward_task(decision, request);
      break;
  }
}

void Input::forward_task(const Decision& decision, const msg::Request& request) {
  if (commands_left_ <= 1) {
    Arbiter(state_.arbiter)
        .refuse(request,
                "more than " + std::to_string(topics::kTaskCommand.max_per_tick - 1) + " task commands in a tick");
    return;
  }
  --commands_left_;
  msg::TaskCommand command{};
  command.goal_id = decision.goal_id;
  command.command = request.command;
  command.task = request.task;
  command.parameters = request.parameters;
  command.path = request.path;
  command_.write(command);
  if (request.command == msg::kCommandStart) {
    state_.last_goal = state_.running_goal = decision.goal_id;
    state_.running_task = request.task;
    state_.moving = false;  // the task ends the motion
    motion_.reset();
  } else if (decision.goal_id == state_.running_goal) {
    state_.running_goal = 0;
  }
}

void Input::forward_motion(const msg::Request& request) {
  msg::MotionCommand motion{};
  set_text(motion.source, state_.arbiter.holder);
  motion.level = request.level;
  motion.motion = request.motion;
  motion.speed_m_s = request.speed_m_s;
  motion.curvature_1_m = request.curvature_1_m;
  motion.angle_rad = request.angle_rad;
  motion_ = motion;
  state_.moving = true;
  state_.running_goal = 0;  // the motion ends the task
}

void Input::set_parameter(const msg::Request& request) {
  if (changes_left_ == 0) {
    Arbiter(state_.arbiter)
        .refuse(request,
                "more than " + std::to_string(topics::kParameterChange.max_per_tick) + " parameter changes in a tick");
    return;
  }
  std::vector<const msg::ParameterList*> lists;
  for (const auto& list : parameters_in_) lists.push_back(list.get());
  const auto decision = ParameterArbiter(state_.parameters).decide(request, lists, now_);
  if (const auto* refusal = std::get_if<std::string>(&decision)) {
    Arbiter(state_.arbiter).refuse(request, *refusal);
    return;
  }
  --changes_left_;
  parameter_out_.write(std::get<msg::ParameterChange>(decision));
}

/// The changes are requested one tick before their own, so that every run writes them at the same tick.
bool Input::set_planned_parameters(const Tick& tick) {
  bool any = false;
  for (const auto& change : planned_) {
    if (change.tick <= tick.index + 1 - tick.elapsed || change.tick > tick.index + 1) continue;
    msg::Request request{};
    set_text(request.source, "input.yaml");
    set_text(request.parameter, change.name);
    request.parameter_value = change.value;
    request.effective_tick = tick.index + 1;
    set_parameter(request);
    any = true;
  }
  return any;
}

void Input::cancel_running() {
  if (state_.moving) {
    motion_ = msg::MotionCommand{};  // stand
    state_.moving = false;
  }
  if (state_.running_goal == 0 || commands_left_ == 0) return;
  --commands_left_;
  msg::TaskCommand command{};
  command.goal_id = state_.running_goal;
  command.command = msg::kCommandCancel;
  command.task = state_.running_task;
  command_.write(command);
  state_.running_goal = 0;
}

void Input::publish_authority(const Tick& tick) {
  state_.last_authority_tick = tick.index;
  msg::Authority authority{};
  authority.level = state_.arbiter.stopped ? msg::kAuthorityEmergencyStop : state_.arbiter.level;
  set_text(authority.source, state_.arbiter.stopped ? state_.arbiter.stopper : state_.arbiter.holder);
  authority.goal_id = state_.last_goal;
  authority.refused_count = state_.arbiter.refused;
  set_text(authority.refusal, state_.arbiter.refusal);
  set_text(authority.refused_source, state_.arbiter.refused_source);
  authority.refused_sequence = state_.arbiter.refused_sequence;
  set_text(authority.answered_source, state_.arbiter.answered_source);
  authority.answered_sequence = state_.arbiter.answered_sequence;
  authority.emergency_stop = state_.arbiter.stopped;
  authority_.write(authority);
}

ComponentFactory make_input_factory(std::shared_ptr<ClientRequests> requests) {
  return {"input",
          [requests = std::move(requests)](Wiring& wiring, const Setup& setup) {
            return std::make_unique<Input>(wiring, setup, requests);
          },
          "components/input/input.yaml"};
}

}  // namespace constrictor
