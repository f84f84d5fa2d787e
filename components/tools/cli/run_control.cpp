// Commands for the time of a run (pause, resume, step, pace, reset) and for its safety (stop, clear-stop, release).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "client/run_control_client.hpp"
#include "client/run_registry.hpp"
#include "common/interrupt.hpp"
#include "common/operator.hpp"
#include "common/replay_control.hpp"
#include "constrictor/text.hpp"
#include "constrictor/topics.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "cyclone/endpoint.hpp"
#include "runtime/host.hpp"
#include "runtime/pacer.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;

struct RunControlOptions {
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
    throw UsageError(fmt::format("PACE: found '{}', accepted lockstep or a factor such as 2x ({}x to {}x)", text,
                                 Pacer::kSlowest, Pacer::kFastest));
  }
  return pace;
}

std::string pace_text(const msg::RunState& state) {
  if (state.realtime) return "real-time pace";
  std::string text =
      state.pace > 0.0 ? fmt::format("at most {}x real time", state.pace) : "lock-step, as fast as possible";
  if (state.operator_pace) text += " while an operator has authority";
  return text;
}

/// What a command does with a run that has not begun.
std::string what_then(std::uint8_t command, const std::string& pace) {
  if (command == msg::kRunPause) return "and will begin with a pause";
  if (command == msg::kRunPace) return fmt::format("and will go on at the pace {}", pace);
  return "and will begin without a pause";
}

/// Says which members a run that has not begun waits for, whenever that changes.
class BeginWatch {
 public:
  BeginWatch(const RunNote& run, std::int32_t participant)
      : run_(run),
        hellos_(dds::Reader<msg::Hello>::member(participant, barrier_topics::kHello.name)),
        missing_(run.roster.begin(), run.roster.end()) {}
  void report() {
    hellos_.take([this](const msg::Hello& hello) { missing_.erase(text_of(hello.component)); });
    const std::string whom =
        missing_.empty() ? "its members to be ready" : fmt::format("{}", fmt::join(missing_, ", "));
    if (std::exchange(told_, whom) == whom) return;
    fmt::print(stderr, "run {} has not begun: it waits for {}; the steps are made when it begins\n", run_.domain, whom);
  }

 private:
  const RunNote& run_;
  dds::Reader<msg::Hello> hellos_;
  std::set<std::string> missing_;
  std::string told_;
};

int control(const RunControlOptions& options, std::uint8_t command) {
  const double pace = command == msg::kRunPace ? parse_pace(options.pace) : 0.0;
  refuse_replay(options.run);
  const RunNote run = join_run(options.run);
  catch_interrupts();
  const dds::Domain domain(run.domain);
  BeginWatch begin(run, domain.participant());
  RunControlClient client(domain.participant(), run.domain, 10s,
                          [&] { return interrupt_signal() != 0 || (run.on_this_host && !domain_claimed(run.domain)); });
  try {
    const msg::RunState state = command == msg::kRunStep
                                    ? client.step(static_cast<std::uint32_t>(options.steps), [&] { begin.report(); })
                                : command == msg::kRunReset ? client.reset(options.seed)
                                : command == msg::kRunPace  ? client.set_pace(pace)
                                : command == msg::kRunPause ? client.pause()
                                                            : client.resume();
    if (state.run_id == 0) fmt::print("run {}: has not begun, {}\n", run.domain, what_then(command, options.pace));
    else if (command == msg::kRunReset)
      fmt::print("run {}: reset to seed {}, epoch {}\n", run.domain, state.seed, state.epoch);
    else if (state.paused) fmt::print("run {}: paused, next tick {}\n", run.domain, state.tick);
    else fmt::print("run {}: running, {}\n", run.domain, pace_text(state));
    return exit_status::kOk;
  } catch (const CommandError& error) {
    if (error.cause() != CommandError::Cause::kInterrupted) throw;
    if (interrupt_signal() == 0)
      throw CommandError(fmt::format("run {}: the run ended before the command was done", run.domain));
    std::fprintf(stderr, "%s\n", error.what());
    return interrupt_status();
  }
}

/// Sends a request that needs no parameters. If `input` grants it, prints the text `granted`.
int ask(RequestClient& client, const char* command, std::uint8_t kind, const char* granted) {
  const auto answer = client.wait_for_answer(client.ask(kind), 5s);
  if (answer == RequestClient::Answer::kGranted) fmt::print("{}\n", granted);
  return report_not_granted(client, answer, command);
}

int clear_stop(RequestClient& client) {
  return ask(client, "clear-stop", msg::kRequestClearStop,
             "emergency stop cleared; the robot stands until `constrictor release` or another request");
}

/// Releases the authority of a script: takes authority and releases it. A planner may then take authority.
int release(RequestClient& client) {
  // `input` refuses this while a person at a terminal has authority. The person keeps it.
  const auto taken = client.wait_for_answer(client.ask(msg::kRequestTake), 5s);
  if (taken == RequestClient::Answer::kRefused) return report_not_granted(client, taken, "release");
  // In every other case authority is released, also after Ctrl-C: the first request may have been granted meanwhile.
  const auto answer = client.wait_for_answer(client.ask(msg::kRequestRelease), 5s);
  if (answer == RequestClient::Answer::kInterrupted && client.release(2s)) {
    fmt::print("release: interrupted, but authority was released\n");
    return interrupt_status();
  }
  if (answer == RequestClient::Answer::kGranted) fmt::print("authority released: a planner may take it\n");
  return report_not_granted(client, answer, "release");
}

int operate(const RunControlOptions& options, const char* command, int (*use)(RequestClient&)) {
  refuse_replay(options.run);
  RequestClient client(join_run(options.run).domain, operator_options(unique_source("operator")));
  if (const int status = connect(client, command); status != exit_status::kOk) return status;
  return use(client);
}

/// The emergency stop goes to `input` and to the plant itself. So it needs neither an answer of `input` nor a token.
int stop(const RunControlOptions& options) {
  catch_interrupts();
  const std::uint32_t domain = options.run ? *options.run : find_run({}).domain;
  RequestClient client(domain, operator_options(unique_source("operator")));
  if (!client.connect_to_stop(5s)) {
    if (interrupt_signal() != 0) return interrupt_status();
    std::fprintf(stderr,
                 "stop: run %u: neither the plant nor `input` is there (is the run in another domain? see `constrictor "
                 "status`)\n",
                 domain);
    return exit_status::kWaitedTooLong;
  }
  const auto answer = client.wait_for_answer(client.ask(msg::kRequestEmergencyStop), 5s);
  if (answer == RequestClient::Answer::kGranted)
    fmt::print("emergency stop: the robot holds its posture until `constrictor clear-stop`\n");
  if (answer == RequestClient::Answer::kNone && client.plant_has_received_stop()) {
    std::fprintf(stderr,
                 "stop: the plant has received the stop and obeys it at its next tick, but the run makes no tick now "
                 "(it is paused, or waits for a process; see `constrictor status`)\n");
    return exit_status::kWaitedTooLong;
  }
  return report_not_granted(client, answer, "stop");
}

}  // namespace

void add_run_control(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RunControlOptions>();
  const std::string time_status = fmt::format("0 done; {}, or no answer;\n  130 interrupted by Ctrl-C", kRunStatuses);
  const std::string safety_status = fmt::format(
      "0 done; 1 refused, with the reason; {};\n  75 no answer within 5 s; 130 interrupted by Ctrl-C", kRunStatuses);
  const auto add = [&](const char* name, const char* text, std::function<int()> what, const std::string& footer) {
    auto* sub = app.add_subcommand(name, text);
    add_run_option(*sub, options->run);
    sub->callback([&action, what = std::move(what)] { action = what; });
    sub->footer(footer);
    return sub;
  };
  const auto controls = [options](std::uint8_t command) {
    return [options, command] { return control(*options, command); };
  };
  const auto operates = [options](const char* command, int (*use)(RequestClient&)) {
    return [options, command, use] { return operate(*options, command, use); };
  };
  add("pause", "halt the ticks of a run", controls(msg::kRunPause),
      help_footer("No process times out while the run is paused, and the result of the run does not change.",
                  {"constrictor pause", "constrictor pause --run 3"}, time_status));
  add("resume", "continue a paused run", controls(msg::kRunResume),
      help_footer("The run continues at the pace that was set before the pause.", {"constrictor resume"}, time_status));
  add("step", "pause a run and let it make one tick, or several", controls(msg::kRunStep),
      help_footer("Waits until the ticks are done, as long as the run makes ticks. A run that has not begun makes them "
                  "when it\n"
                  "begins. Ctrl-C ends the wait, not the steps.",
                  {"constrictor step", "constrictor step 50       # one second"},
                  fmt::format("0 done; {},\n  or no tick for 10 s; 130 interrupted by Ctrl-C", kRunStatuses)))
      ->add_option("TICKS", options->steps, "number of ticks, 1 to 1000000")
      ->check(whole_number(1, 1'000'000))
      ->capture_default_str();
  add("pace", "limit how fast a run goes", controls(msg::kRunPace),
      help_footer("While an operator has authority, lock-step is limited to real time. A pace that is set meanwhile "
                  "replaces that limit.",
                  {"constrictor pace lockstep", "constrictor pace 2x"}, time_status))
      ->add_option("PACE", options->pace,
                   "lockstep (as fast as possible), or at most N times real time: 2x (0.001x to 1000x)")
      ->required();
  add("reset", "begin a run again, with another seed", controls(msg::kRunReset),
      help_footer("Processes and report directory stay. The run becomes the one that `constrictor run --seed SEED` "
                  "makes.",
                  {"constrictor reset 7"}, time_status))
      ->add_option("SEED", options->seed, "the seed")
      ->required()
      ->check(whole_number());
  add(
      "stop", "latch an emergency stop: the robot holds its posture", [options] { return stop(*options); },
      help_footer("Needs no token. The plant itself obeys it, also while `input` hangs. It stays latched until "
                  "`constrictor clear-stop`.",
                  {"constrictor stop"},
                  fmt::format("0 the stop is latched; {}; 75 no answer within 5 s;\n  130 interrupted by Ctrl-C: the "
                              "request was sent, but is not confirmed",
                              kRunStatuses)));
  add("clear-stop", "clear an emergency stop; the robot does not move", operates("clear-stop", clear_stop),
      help_footer("No source has authority afterwards; `constrictor release` lets the planner take it.",
                  {"constrictor clear-stop && constrictor release"}, safety_status));
  add("release", "give authority back to the planner, also after an emergency stop", operates("release", release),
      help_footer(
          "Releases the authority of a script (`constrictor task`). If no source has authority, the planner may "
          "take it. A person at `constrictor\nteleop` keeps authority.",
          {"constrictor task wait --end && constrictor release"}, safety_status));
}

}  // namespace constrictor::cli
