// Control of the run from outside: pause, resume, step, pace, reset, end; and what the run says about itself.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "constrictor/reflect.hpp"
#include "runtime/host_impl.hpp"

namespace constrictor {
namespace {

constexpr auto kStateEvery = std::chrono::seconds(1);

}  // namespace

void Host::Impl::take_control(const msg::RunControl& control) {
  std::string refusal;
  if (const auto violation = validate(control)) {
    refusal = "run_control." + *violation;
  } else if (!control_sources_.take(control.source, control.sequence_number)) {
    refusal = "run_control.sequence_number: heard before, or after a higher one of this source";
  } else {
    refusal = obey_control(control);
  }
  if (!refusal.empty()) {
    std::fprintf(stderr, "%s: run_control refused: %s\n", options_.plant.c_str(), refusal.c_str());
    members_.front().member->refuse(refusal);
  }
  dds::set_text(run_state_.control_source, control.source);
  run_state_.control_sequence = control.sequence_number;
  dds::set_text(run_state_.refusal, refusal);
  publish_run_state(true);
}

std::string Host::Impl::obey_control(const msg::RunControl& control) {
  switch (control.command) {
    case msg::kRunReset:
      if (!conductor_->epoch()) return "reset: the run has not begun";
      conductor_->reset(control.seed);
      break;
    case msg::kRunEnd:
      if (!conductor_->epoch()) return "end: the run has not begun";
      conductor_->end_run();
      pacer_.control(msg::kRunResume, 0.0);  // the final tick must come
      break;
    case msg::kRunPace:
      if (options_.realtime) return "pace: this run goes by the wall clock";
      if (!Pacer::accepts(control.pace)) return fmt::format("pace: found {}, accepted 0 or {} to {}", control.pace, Pacer::kSlowest, Pacer::kFastest);
      pacer_.control(control.command, control.pace);
      break;
    default:
      // Of a step, `seed` is the number of ticks.
      pacer_.control(control.command, control.pace, static_cast<std::int64_t>(std::min<std::uint64_t>(control.seed, 1'000'000)));
      break;
  }
  return {};
}

void Host::Impl::note_authority(const TopicInfo& topic, const Sample& sample) {
  if (!conductor_ || topic.id != topics::kAuthority.id || sample.header->run_id != conductor_->run_id()) return;
  const auto& authority = *static_cast<const msg::Authority*>(sample.message.get());
  const bool before = pacer_.capped();
  // A stop is a person's doing too: the run must not race on while somebody reaches for the robot.
  pacer_.operator_holds(authority.level >= msg::kAuthorityOperator);
  if (pacer_.capped() != before) publish_run_state(true);
}

void Host::Impl::publish_run_state(bool changed) {
  const auto now = SteadyClock::now();
  const bool due = now - last_run_state_ >= kStateEvery;
  if ((!changed && !due) || !conductor_->epoch()) return;
  msg::RunState& state = run_state_;
  const bool same_epoch = state.run_id == conductor_->epoch()->run_id && state.epoch == conductor_->epoch()->epoch;
  if (due || !same_epoch) {
    const double wall_s = std::chrono::duration<double>(now - last_run_state_).count();
    const double simulated_s = 1e-9 * static_cast<double>((conductor_->next_index() - state.tick) * static_cast<Plant&>(plant_->component()).period_ns());
    const bool known = same_epoch && last_run_state_ != SteadyClock::time_point{};
    state.real_time_factor = known ? simulated_s / wall_s : std::numeric_limits<double>::quiet_NaN();
    last_run_state_ = now;
    state.tick = conductor_->next_index();
  }
  state.run_id = conductor_->epoch()->run_id;
  state.epoch = conductor_->epoch()->epoch;
  state.seed = conductor_->seed();
  msg::RunState message = state;
  message.tick = conductor_->next_index();
  message.paused = pacer_.paused();
  message.held = conductor_->may_tick();
  message.realtime = options_.realtime;
  message.pace = pacer_.pace();
  message.operator_cap = pacer_.capped();
  run_state_writer_.write(message);
}

}  // namespace constrictor
