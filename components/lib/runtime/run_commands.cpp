// The part of ConductorSide that obeys `run_control` (pause, resume, step, pace, reset, end) and publishes RunState.
#include <fmt/format.h>

#include <limits>

#include "runtime/conductor_side.hpp"
#include "runtime/member_side.hpp"

namespace constrictor {
namespace {

constexpr auto kStateInterval = std::chrono::seconds(1);

}  // namespace

void ConductorSide::take_stop(const msg::EmergencyStop& stop) {
  // A stop is obeyed whatever its other fields contain. The plant latches it at its next tick.
  if (stop.robot_id != context_.options.setup.robot_id || !plant_.stop_orders()) return;
  plant_.stop_orders()->add(text_of(stop.source));
  // The sender is told that the plant has received it, so that a successor must obey it, too. For that, one is enough.
  if (plant_.stop_orders()->waiting().count == 1) save();
}

void ConductorSide::refuse_stranger(const msg::RunControl& control, const std::string& reason) {
  plant_.refuse(fmt::format("run_control: {}", reason));
  if (!strangers_.allows(HostContext::Clock::now())) return;
  if (strangers_.first()) context_.log.warning("run_control of '{}' refused: {}", text_of(control.source), reason);
  msg::RunControlAnswer answer{};
  dds::set_text(answer.source, text_of(control.source));
  answer.sequence_number = control.sequence_number;
  dds::set_text(answer.refusal, reason);
  control_answer_writer_.write(answer);  // not kept: a stranger must not displace the answers to others
}

void ConductorSide::take_control(const msg::RunControl& control) {
  const std::string why = context_.stranger(control.token, control.run_id, conductor_->run_id());
  if (!why.empty()) return refuse_stranger(control, why);
  // A client repeats a command until it is answered. The command is obeyed once; later copies get the first answer.
  if (const auto* given = control_answers_.given(control)) return control_answer_writer_.write(*given);
  std::string refusal;
  if (const auto violation = validate(control)) {
    refusal = "run_control." + *violation;
  } else if (const auto newest = control_answers_.newest(control.source); newest >= control.sequence_number) {
    refusal = fmt::format("run_control.sequence_number: found {}, accepted more than {}, the last of this source",
                          control.sequence_number, newest);
  } else {
    refusal = obey(control);
  }
  if (!refusal.empty()) {
    context_.log.warning("run_control refused: {}", refusal);
    plant_.refuse(refusal);
  }
  publish_run_state(true);
  msg::RunControlAnswer answer{};
  dds::set_text(answer.source, control.source);
  answer.sequence_number = control.sequence_number;
  dds::set_text(answer.refusal, refusal);
  if (conductor_->epoch()) answer.state = current_run_state();
  control_answers_.keep(answer);
  control_answers_bytes_.reset();
  save();  // a successor must neither forget the command nor obey it again
  control_answer_writer_.write(answer);
}

std::string ConductorSide::obey(const msg::RunControl& control) {
  switch (control.command) {
    case msg::kRunReset:
      if (!conductor_->epoch()) return "reset: the run has not begun";
      conductor_->reset(control.seed);
      break;
    case msg::kRunEnd:
      if (!conductor_->epoch()) return "end: the run has not begun";
      conductor_->end_run();
      pacer_.control(msg::kRunResume, 0.0);  // a paused run must still send its final tick
      break;
    case msg::kRunPace:
      if (context_.options.realtime) return "pace: this run goes by the wall clock";
      if (!Pacer::accepts(control.pace))
        return fmt::format("pace: found {}, accepted 0 or {} to {}", control.pace, Pacer::kSlowest, Pacer::kFastest);
      pacer_.control(control.command, control.pace);
      break;
    default:
      pacer_.control(control.command, control.pace, static_cast<std::int64_t>(control.ticks));
      members_.on_pause();  // the pause does not count as a late tick
      break;
  }
  return {};
}

void ConductorSide::note_authority(const TopicInfo& topic, const Sample& sample) {
  if (topic.id != topics::kAuthority.id || sample.header->run_id != conductor_->run_id()) return;
  const auto& authority = *static_cast<const msg::Authority*>(sample.message.get());
  const bool before = pacer_.capped();
  // The cap also holds after an emergency stop: a person may be reaching for the robot.
  pacer_.operator_holds(authority.level >= msg::kAuthorityOperator);
  if (pacer_.capped() != before) publish_run_state(true);
}

void ConductorSide::publish_run_state(bool changed) {
  const auto now = HostContext::Clock::now();
  const bool due = now - last_run_state_ >= kStateInterval;
  if ((!changed && !due) || !conductor_->epoch()) return;
  msg::RunState& state = run_state_;
  const bool same_epoch = state.run_id == conductor_->epoch()->run_id && state.epoch == conductor_->epoch()->epoch;
  if (due || !same_epoch) {
    const double wall_s = std::chrono::duration<double>(now - last_run_state_).count();
    const double simulated_s = 1e-9 * static_cast<double>((conductor_->next_index() - state.tick) * period_ns());
    const bool known = same_epoch && last_run_state_ != HostContext::Clock::time_point{};
    state.real_time_factor = known ? simulated_s / wall_s : std::numeric_limits<double>::quiet_NaN();
    last_run_state_ = now;
    state.tick = conductor_->next_index();
  }
  state.run_id = conductor_->epoch()->run_id;
  state.epoch = conductor_->epoch()->epoch;
  run_state_writer_.write(current_run_state());
}

msg::RunState ConductorSide::current_run_state() const {
  msg::RunState state = run_state_;
  state.run_id = conductor_->epoch()->run_id;
  state.epoch = conductor_->epoch()->epoch;
  state.seed = conductor_->seed();
  state.tick = conductor_->next_index();
  state.paused = pacer_.paused();
  state.ready_for_tick = conductor_->may_tick();
  state.realtime = context_.options.realtime;
  state.pace = pacer_.pace();
  state.operator_pace = pacer_.capped();
  return state;
}

}  // namespace constrictor
