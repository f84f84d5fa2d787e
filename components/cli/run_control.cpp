#include "cli/run_control.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <thread>

#include "cli/control_answer.hpp"
#include "cli/operator_client.hpp"
#include "cli/run_registry.hpp"
#include "cli/usage.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/dds/wire.hpp"
#include "runtime/host.hpp"
#include "runtime/pacer.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
constexpr auto kPoll = 10ms;
constexpr auto kBound = 10s;

struct Options {
  std::optional<std::uint32_t> run;
  std::uint64_t steps = 1;
  std::uint64_t seed = 1;
  std::string pace;
};

double parse_pace(const std::string& text) {
  if (text == "lockstep") return 0.0;
  char* end = nullptr;
  const double pace = std::strtod(text.c_str(), &end);
  const bool number = end != text.c_str() && (*end == '\0' || std::string(end) == "x");
  if (!number || !(pace > 0.0 && Pacer::accepts(pace))) {
    throw UsageError(fmt::format("PACE: found '{}', accepted lockstep or a factor such as 2x ({}x to {}x)", text, Pacer::kSlowest, Pacer::kFastest));
  }
  return pace;
}

/// Sends commands on `run_control` and hears the conductor's answers.
class RunControlClient {
 public:
  explicit RunControlClient(std::uint32_t domain)
      : source_(unique_source("control")), domain_(domain),
        state_(dds::Reader<msg::RunState>::member(domain_.participant(), dds::barrier_topics::kRunState)),
        control_(domain_.participant(), dds::barrier_topics::kRunControl, 1) {}

  /// The state after the command was obeyed. Throws RegistryError if it was refused or nobody answered.
  msg::RunState send(msg::RunControl command) {
    dds::set_text(command.source, source_);
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    sequence_ = std::max(sequence_ + 1, static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::microseconds>(now).count()));
    command.sequence_number = sequence_;
    WaitBound bound(WaitBound::For::kAnswer, kBound, Clock::now());
    // The conductor keeps one answer, of its last command: whoever hears it late hears somebody else's.
    while (state_.writers() == 0 && !bound.over(Clock::now())) std::this_thread::sleep_for(kPoll);
    control_.write(command);
    const auto state = wait(bound, "answer from", [&](const msg::RunState& s) { return answer_to(command, s) != ControlAnswer::kNone; });
    switch (answer_to(command, state)) {
      case ControlAnswer::kRefused: throw RegistryError(state.refusal);
      case ControlAnswer::kOvertaken: throw RegistryError("overtaken by a later command of this name; `constrictor status` tells the state");
      default: return state;
    }
  }
  /// The first state for which `condition` holds, however long that takes, as long as the run makes ticks. Throws RegistryError if it
  /// does not.
  template <class Condition>
  msg::RunState wait_for_ticks(Condition&& condition) {
    return wait(WaitBound(WaitBound::For::kTicks, kBound, Clock::now()), "further tick of", condition);
  }

 private:
  template <class Condition>
  msg::RunState wait(WaitBound bound, const char* missing, Condition&& condition) {
    for (;;) {
      std::optional<msg::RunState> found;
      state_.take([&](const msg::RunState& s) {
        if (!found && condition(s)) found = s;
        bound.heard(s.tick, Clock::now());
      });
      if (found) return *found;
      if (bound.over(Clock::now())) {
        const std::string tick = bound.next_tick() < 0 ? "" : fmt::format("; its next tick is {}", bound.next_tick());
        throw RegistryError(fmt::format("no {} the run within {} s{}", missing, kBound.count(), tick));
      }
      std::this_thread::sleep_for(kPoll);
    }
  }

  std::string source_;
  std::uint64_t sequence_ = 0;
  dds::Domain domain_;
  dds::Reader<msg::RunState> state_;
  dds::Writer<msg::RunControl> control_;
};

std::string pace_text(const msg::RunState& state) {
  if (state.realtime) return "real-time pace";
  std::string text = state.pace > 0.0 ? fmt::format("at most {}x real time", state.pace) : "lock-step, as fast as it goes";
  if (state.operator_cap) text += " while an operator has authority";
  return text;
}

int control(const Options& options, std::uint8_t command) {
  msg::RunControl message{};
  message.command = command;
  if (command == msg::kRunStep) message.seed = options.steps;
  if (command == msg::kRunReset) message.seed = options.seed;
  if (command == msg::kRunPace) message.pace = parse_pace(options.pace);
  const RunNote run = find_run(options.run);
  RunControlClient client(run.domain);
  std::int64_t from = 0;
  if (command == msg::kRunStep) {
    msg::RunControl pause{};
    pause.command = msg::kRunPause;
    from = client.send(pause).tick;  // from here on only the steps move it
  }
  msg::RunState state = client.send(message);
  if (command == msg::kRunStep) {
    const auto done = [&](const msg::RunState& s) { return s.tick >= from + static_cast<std::int64_t>(options.steps); };
    if (!done(state)) state = client.wait_for_ticks(done);
  }
  if (command == msg::kRunReset) fmt::print("run {}: reset to seed {}, epoch {}\n", run.domain, state.seed, state.epoch);
  else if (state.paused) fmt::print("run {}: paused, next tick {}\n", run.domain, state.tick);
  else fmt::print("run {}: runs, {}\n", run.domain, pace_text(state));
  return exit_status::kOk;
}

/// Asks `input` as an operator and tells the answer. 75 if there is none, which a paused run explains.
int ask(OperatorClient& client, std::uint8_t kind, const char* granted) {
  switch (client.wait_for_answer(client.ask(kind), 5s)) {
    case OperatorClient::Answer::kGranted: fmt::print("{}\n", granted); return exit_status::kOk;
    case OperatorClient::Answer::kRefused:
      std::fprintf(stderr, "refused: %s\n", client.refusal().c_str());
      return exit_status::kMissionFailed;
    case OperatorClient::Answer::kNone: break;
  }
  std::fprintf(stderr, "no answer within 5 s; is the run paused? It is told as soon as the run goes on\n");
  client.flush();
  return exit_status::kWaitedTooLong;
}

int operate(const Options& options, const std::function<int(OperatorClient&)>& use) {
  const RunNote run = find_run(options.run);
  OperatorClient client(run.domain, unique_source("operator"), 0ms);
  if (!client.connect(5s)) {
    std::fprintf(stderr, "run %u has no `input` that listens\n", run.domain);
    return exit_status::kWaitedTooLong;
  }
  return use(client);
}

int stop(OperatorClient& client) {
  return ask(client, msg::kRequestEmergencyStop, "emergency stop: the posture is held until `constrictor clear-stop`");
}

int clear_stop(OperatorClient& client) {
  return ask(client, msg::kRequestClearStop, "emergency stop cleared; nothing moves until `constrictor release` or another request");
}

/// Takes authority, and gives it to whoever takes it up: the built-in planner, if there is one.
int release(OperatorClient& client) {
  // A detached holder, or nobody: its authority is ours to give back. Whoever sits at a terminal keeps it.
  const auto taken = client.wait_for_answer(client.ask(msg::kRequestTake), 5s);
  if (taken == OperatorClient::Answer::kRefused) {
    std::fprintf(stderr, "refused: %s\n", client.refusal().c_str());
    return exit_status::kMissionFailed;
  }
  return ask(client, msg::kRequestRelease, "released: a planner may take up");
}

}  // namespace

void add_run_control(CLI::App& app, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  const std::string time_status = fmt::format("0 done; {}, or no answer", kRunStatuses);
  const std::string safety_status = fmt::format("0 done; 1 refused, with the reason; {};\n  75 no answer within 5 s", kRunStatuses);
  const auto add = [&](const char* name, const char* text, std::function<int()> what, const std::string& footer) {
    auto* sub = app.add_subcommand(name, text);
    add_run_option(*sub, options->run);
    sub->callback([&action, what = std::move(what)] { action = what; });
    sub->footer(footer);
    return sub;
  };
  const auto controls = [options](std::uint8_t command) { return [options, command] { return control(*options, command); }; };
  add("pause", "halt a run's time", controls(msg::kRunPause),
      help_footer("Nobody loses patience with anybody meanwhile, and the result stays the same.", {"constrictor pause", "constrictor pause --run 3"}, time_status));
  add("resume", "let a paused run go on", controls(msg::kRunResume),
      help_footer("At the pace that was in force.", {"constrictor resume"}, time_status));
  add("step", "let a run do one tick, or so many, and pause it", controls(msg::kRunStep),
      help_footer("Waits until they are done, as long as the run makes ticks.", {"constrictor step", "constrictor step 50       # one second"},
                  fmt::format("0 done; {},\n  or no tick for 10 s", kRunStatuses)))
      ->add_option("TICKS", options->steps, "how many, 1 to 1000000")->check(whole_number())->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1'000'000}))->capture_default_str();
  add("pace", "set how fast a run may go", controls(msg::kRunPace),
      help_footer("While an operator has authority lock-step is capped at real time; a pace set meanwhile overrules that.",
                  {"constrictor pace lockstep", "constrictor pace 2x"}, time_status))
      ->add_option("PACE", options->pace, "lockstep (as fast as it goes), or at most N times real time: 2x (0.001x to 1000x)")->required();
  add("reset", "begin a run anew, with another seed", controls(msg::kRunReset),
      help_footer("In the same processes and report directory. The run is then the one that `constrictor run --seed SEED` makes.", {"constrictor reset 7"}, time_status))
      ->add_option("SEED", options->seed, "the seed")->required()->check(whole_number());
  add("stop", "latched emergency stop: the robot holds its posture", [options] { return operate(*options, stop); },
      help_footer("From anybody, at any time. It lasts until `constrictor clear-stop`.", {"constrictor stop"},
                  fmt::format("0 `input` has it; {}; 75 no answer within 5 s", kRunStatuses)));
  add("clear-stop", "clear an emergency stop; starts no motion", [options] { return operate(*options, clear_stop); },
      help_footer("Authority is with nobody then: `constrictor release` lets the planner take up.", {"constrictor clear-stop && constrictor release"}, safety_status));
  add("release", "give authority back to the planner, also after an emergency stop", [options] { return operate(*options, release); },
      help_footer("Authority of nobody, or of a script (`constrictor task`). Whoever sits at a `constrictor teleop` keeps it.",
                  {"constrictor task wait --end && constrictor release"}, safety_status));
}

}  // namespace constrictor::cli
