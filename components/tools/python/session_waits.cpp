// The functions of a session that wait for the robot, and those for parameters and stops.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "client/parameters.hpp"
#include "client/polling.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/endpoint.hpp"
#include "python/session.hpp"
#include "python/turn.hpp"

namespace constrictor::python {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;

/// The bound of a wait [s]; empty: none.
class Bound {
 public:
  explicit Bound(std::optional<double> seconds) : seconds_(seconds) {
    if (seconds && !(*seconds >= 0.0 && *seconds <= 1e6))
      throw std::invalid_argument(fmt::format("timeout: found {}, accepted 0 to 1000000 s, or None", *seconds));
  }
  [[nodiscard]] bool over() const {
    return seconds_ && WaitClock::now() - start_ > std::chrono::duration<double>(*seconds_);
  }
  [[nodiscard]] double seconds() const { return *seconds_; }

 private:
  std::optional<double> seconds_;
  WaitClock::time_point start_ = WaitClock::now();
};

}  // namespace

std::pair<std::string, std::string> Session::wait_for_end(std::uint64_t goal, std::optional<double> timeout_s) {
  const Bound bound(timeout_s);
  const Turn turn(*this);
  const auto end = client().wait_for_end(goal, [&] {
    expect_going_on();
    if (bound.over() && !client_->goals().end(goal, false))
      throw WaitTimeout(
          fmt::format("goal {} has not ended within {} s; it goes on", goal_number(goal), bound.seconds()));
  });
  return {name_of(constants::kGoal, end.state), end.reason};
}

msg::TaskEvent Session::wait_for_event(std::uint64_t goal, const std::string& event, std::optional<double> timeout_s) {
  const Bound bound(timeout_s);
  const auto kind = value_of(constants::kEvent, event);
  if (!kind || *kind == msg::kEventNone)
    throw std::invalid_argument(fmt::format("event: found '{}', accepted {}", event, listed(constants::kEvent, 1)));
  const Turn turn(*this);
  const std::uint32_t epoch = client().goals().epoch();
  std::optional<WaitClock::time_point> ended;
  for (;; next_poll()) {
    client_->poll();
    const GoalTracker& goals = client_->goals();
    if (const msg::TaskEvent* found = goals.event(goal, *kind)) return *found;
    expect_going_on();
    if (epoch != 0 && goals.epoch() != epoch) throw CommandError("the run was reset while the goal was running");
    // A grasp may be lost after its goal has succeeded. Every other event of a goal comes before its end.
    if (const auto end = goals.end(goal, true); end && *kind != msg::kEventObjectGraspLost) {
      if (!ended) ended = WaitClock::now();
      if (goals.end(goal, false) || WaitClock::now() - *ended > 1s) {
        throw CommandError(fmt::format("no \"{}\" of goal {}: it has {}{}{}", words_of(constants::kEvent, *kind),
                                       goal_number(goal), name_of(constants::kGoal, end->state),
                                       end->reason.empty() ? "" : ": ", end->reason));
      }
    }
    if (bound.over()) {
      throw WaitTimeout(fmt::format("no \"{}\" of goal {} within {} s; the goal goes on",
                                    words_of(constants::kEvent, *kind), goal_number(goal), bound.seconds()));
    }
  }
}

std::vector<msg::TaskEvent> Session::events(std::uint64_t goal) {
  const Turn turn(*this);
  client().poll();
  std::vector<msg::TaskEvent> list;
  for (const auto& event : client_->goals().events()) {
    if (event.goal_id == goal) list.push_back(event);
  }
  return list;
}

void Session::emergency_stop() {
  const Turn turn(*this);
  need_run();
  // client() is not used here: the stop also goes to the plant, which executes it even if `input` hangs.
  if (!client_) client_ = std::make_unique<RequestClient>(participant_->participant(), domain_, request_options_);
  if (!client_->connect_to_stop(5s)) {
    throw CommandError(fmt::format("run {}: neither the plant nor `input` reads emergency stops (see `constrictor "
                                   "status --run {}`)",
                                   domain_, domain_),
                       CommandError::Cause::kNoAnswer);
  }
  const std::uint64_t number = client_->ask(msg::kRequestEmergencyStop);
  const auto answer = client_->wait_for_answer(number, 5s);
  if (answer == RequestClient::Answer::kNone && client_->plant_has_received_stop()) {
    throw CommandError(
        "the plant has received the stop and obeys it at its next tick, but the run makes no tick now "
        "(it is paused, or waits for a process; see `constrictor status`)",
        CommandError::Cause::kNoAnswer);
  }
  granted(answer);
}

void Session::clear_stop() {
  const Turn turn(*this);
  granted(client().ask(msg::kRequestClearStop));
}

void Session::wait(double duration_s) {
  if (!(duration_s >= 0.0 && duration_s <= 1e6))
    throw std::invalid_argument(fmt::format("duration: found {}, accepted 0 to 1000000 s", duration_s));
  const Turn turn(*this);
  need_run();
  // Each message of `input` and of the plant has the robot's time, but only the plant writes one at every tick.
  const auto reader =
      dds::Reader<msg::JointState>::observer(participant_->participant(), std::string(topics::kJointState.name), 1);
  std::optional<std::int64_t> from_ns;
  for (bool done = false; !done; next_poll()) {
    expect_going_on();
    reader.take([&](const msg::JointState& state) {
      if (!monitor_->is_present(state.header)) return;
      // After a reset the time begins again.
      if (!from_ns || state.header.time_ns < *from_ns) from_ns = state.header.time_ns;
      done = done || static_cast<double>(state.header.time_ns - *from_ns) >= duration_s * 1e9;
    });
    if (duration_s == 0.0) return;
  }
}

Json Session::parameters() {
  const Turn turn(*this);
  need_run();
  Json json = Json::object();
  for (const auto& [name, owned] : read_parameters(participant_->participant()).parameters) json[name] = to_json(owned);
  return json;
}

std::pair<double, std::int64_t> Session::set_parameter(const std::string& name, double value, std::int64_t tick) {
  if (!std::isfinite(value))
    throw std::invalid_argument(fmt::format("value of {}: found {}, accepted a number", name, value));
  if (tick < 0) throw std::invalid_argument(fmt::format("at_tick: found {}, accepted a tick from 1", tick));
  const Turn turn(*this);
  const auto change = ParameterSetter(client()).set(name, value, tick);
  return {change.value, change.effective_tick};
}

msg::RunState Session::control(const std::function<msg::RunState(RunControlClient&)>& use) {
  const Turn turn(*this);
  need_run();
  if (!control_) {
    control_ = std::make_unique<RunControlClient>(
        participant_->participant(), domain_, 10s, [this] { return pass() || over_now(); }, request_options_.key);
  }
  try {
    return use(*control_);
  } catch (const CommandError& error) {
    if (error.cause() == CommandError::Cause::kInterrupted && over_now())
      throw CommandError(fmt::format("run {}: the run ended before the command was done", domain_));
    throw;
  }
}

bool Session::over_now() {
  monitor_->poll();
  return !monitor_->attachment().over().empty();
}

}  // namespace constrictor::python
