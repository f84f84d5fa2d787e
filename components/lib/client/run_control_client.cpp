#include "client/run_control_client.hpp"

#include <fmt/format.h>

#include <optional>
#include <thread>
#include <utility>

#include "client/polling.hpp"
#include "client/source.hpp"
#include "client/tick_wait.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/endpoint.hpp"

namespace constrictor {
namespace {

using namespace std::chrono_literals;
constexpr auto kRepeatEvery = 500ms;
constexpr auto kSettle = 1s;  // until the state of a run that goes on has arrived

}  // namespace

struct RunControlClient::Endpoints {
  explicit Endpoints(std::uint32_t domain) : own(std::in_place, domain) { open(own->participant()); }
  struct OnParticipant {
    std::int32_t participant;
  };
  explicit Endpoints(OnParticipant other) { open(other.participant); }
  void open(std::int32_t participant) {
    states = dds::Reader<msg::RunState>::member(participant, barrier_topics::kRunState);
    answers = dds::Reader<msg::RunControlAnswer>::member(participant, barrier_topics::kRunControlAnswer);
    control = dds::Writer<msg::RunControl>(participant, barrier_topics::kRunControl, 1);
  }
  std::optional<dds::Domain> own;  ///< empty: the participant is the caller's
  dds::Reader<msg::RunState> states;
  dds::Reader<msg::RunControlAnswer> answers;
  dds::Writer<msg::RunControl> control;
};

RunControlClient::RunControlClient(std::unique_ptr<Endpoints> endpoints, std::uint32_t domain,
                                   std::chrono::seconds bound, std::function<bool()> interrupted,
                                   std::optional<RunKey> key)
    : endpoints_(std::move(endpoints)),
      domain_(domain),
      bound_(bound),
      interrupted_(std::move(interrupted)),
      source_(unique_source("control")),
      sequence_(first_sequence_number()),
      key_(key ? std::move(*key) : run_key(domain)) {}

RunControlClient::RunControlClient(std::uint32_t domain, std::chrono::seconds bound, std::function<bool()> interrupted)
    : RunControlClient(std::make_unique<Endpoints>(domain), domain, bound, std::move(interrupted), {}) {}

RunControlClient::RunControlClient(std::int32_t participant, std::uint32_t domain, std::chrono::seconds bound,
                                   std::function<bool()> interrupted, std::optional<RunKey> key)
    : RunControlClient(std::make_unique<Endpoints>(Endpoints::OnParticipant{participant}), domain, bound,
                       std::move(interrupted), std::move(key)) {}

RunControlClient::~RunControlClient() = default;

msg::RunState RunControlClient::send(msg::RunControl command) {
  dds::set_text(command.source, source_);
  command.sequence_number = ++sequence_;
  command.run_id = key_.run_id;
  dds::set_text(command.token, key_.token);
  const auto end = WaitClock::now() + bound_;
  auto repeat_at = WaitClock::now();
  for (std::optional<msg::RunControlAnswer> answer; WaitClock::now() < end; std::this_thread::sleep_for(kPoll)) {
    if (WaitClock::now() >= repeat_at) {
      endpoints_->control.write(command);
      repeat_at = WaitClock::now() + kRepeatEvery;
    }
    endpoints_->answers.take([&](const msg::RunControlAnswer& each) {
      if (each.source == source_ && each.sequence_number == command.sequence_number) answer = each;
    });
    if (answer) {
      if (*answer->refusal) throw CommandError(answer->refusal, CommandError::Cause::kRefused);
      return answer->state;
    }
    if (interrupted_ && interrupted_()) {
      throw CommandError(fmt::format("run {}: interrupted before the run answered; the command may still be obeyed "
                                     "(see `constrictor status --run {}`)",
                                     domain_, domain_),
                         CommandError::Cause::kInterrupted);
    }
  }
  throw CommandError(fmt::format("run {}: no answer from the plant's process within {} s (is it running? see "
                                 "`constrictor status --run {}`)",
                                 domain_, bound_.count(), domain_),
                     CommandError::Cause::kNoAnswer);
}

msg::RunState RunControlClient::send(std::uint8_t command) {
  msg::RunControl message{};
  message.command = command;
  return send(message);
}

msg::RunState RunControlClient::pause() { return send(msg::kRunPause); }
msg::RunState RunControlClient::resume() { return send(msg::kRunResume); }
msg::RunState RunControlClient::end() { return send(msg::kRunEnd); }

msg::RunState RunControlClient::set_pace(double pace) {
  msg::RunControl message{};
  message.command = msg::kRunPace;
  message.pace = pace;
  return send(message);
}

msg::RunState RunControlClient::reset(std::uint64_t seed) {
  msg::RunControl message{};
  message.command = msg::kRunReset;
  message.seed = seed;
  return send(message);
}

void RunControlClient::throw_if_interrupted(const char* what) const {
  if (interrupted_ && interrupted_())
    throw CommandError(fmt::format("run {}: interrupted; {}", domain_, what), CommandError::Cause::kInterrupted);
}

std::optional<msg::RunState> RunControlClient::first_state(std::chrono::milliseconds bound) {
  std::optional<msg::RunState> found;
  for (const auto end = WaitClock::now() + bound; !found && WaitClock::now() < end;
       std::this_thread::sleep_for(kPoll)) {
    endpoints_->states.take([&](const msg::RunState& state) {
      if (key_.run_id == 0 || state.run_id == key_.run_id) found = state;
    });
    throw_if_interrupted("the run has not begun");
  }
  return found;
}

/// A run that has not begun takes the pause, too, if its plant is there: it then begins without a tick.
msg::RunState RunControlClient::pause_before_steps(const std::function<void()>& waiting) {
  const bool begun = first_state(kSettle).has_value();
  if (!begun && waiting) waiting();
  for (const auto end = WaitClock::now() + bound_;;) {
    try {
      const msg::RunState state = pause();
      if (state.run_id != 0) return state;
    } catch (const CommandError& error) {
      if (error.cause() != CommandError::Cause::kNoAnswer || begun || !waiting) throw;
    }
    while (!first_state(kRepeatEvery)) {
      if (waiting) waiting();
      else if (WaitClock::now() > end)
        throw CommandError(
            fmt::format("run {}: the run has not begun (see `constrictor status --run {}`)", domain_, domain_),
            CommandError::Cause::kNoAnswer);
    }
  }
}

msg::RunState RunControlClient::step(std::uint32_t ticks, const std::function<void()>& waiting) {
  const std::int64_t from = pause_before_steps(waiting).tick;  // from here on only the steps move the run
  msg::RunControl message{};
  message.command = msg::kRunStep;
  message.ticks = ticks;
  const msg::RunState state = send(message);
  return state.tick >= from + ticks ? state : wait_for_tick(state.run_id, from + ticks);
}

msg::RunState RunControlClient::wait_for_tick(std::uint64_t run_id, std::int64_t tick) {
  for (TickWait wait(bound_, WaitClock::now());; std::this_thread::sleep_for(kPoll)) {
    std::optional<msg::RunState> found;
    endpoints_->states.take([&](const msg::RunState& state) {
      if (state.run_id != run_id) return;  // of another run that has claimed the domain since
      if (!found && state.tick >= tick) found = state;
      wait.heard(state.tick, WaitClock::now());
    });
    if (found) return *found;
    if (wait.over(WaitClock::now())) {
      const std::string next = wait.next_tick() < 0 ? "" : fmt::format("; its next tick is {}", wait.next_tick());
      throw CommandError(fmt::format("run {}: no further tick within {} s{} (see `constrictor status --run {}`)",
                                     domain_, bound_.count(), next, domain_),
                         CommandError::Cause::kNoAnswer);
    }
    throw_if_interrupted("the run makes the remaining steps and then pauses");
  }
}

}  // namespace constrictor
