#include "cli/task_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "cli/goal_watch.hpp"
#include "cli/operator_client.hpp"
#include "cli/run_registry.hpp"
#include "cli/task_names.hpp"
#include "cli/usage.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/domain_claim.hpp"
#include "runtime/host.hpp"
#include "runtime/topics.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
constexpr auto kPoll = 10ms;
constexpr auto kAnswerBound = 5s;
constexpr auto kSettle = 200ms;
/// One source for all scripts of a run: what one started another may cancel.
constexpr const char* kSource = "task";

struct Options {
  std::optional<std::uint32_t> run;
  std::string name;
  std::map<std::string, std::string> parameters;
  std::vector<std::string> path;  ///< "X,Y" each
  std::string goal;               ///< a number, "any", or empty: the newest
  std::string event;
  bool end = false;
  std::string timeout = "60s";
};

/// What `input` and navigation say of goals.
class GoalReaders {
 public:
  explicit GoalReaders(dds_entity_t participant)
      : authority_(dds::Reader<msg::Authority>::member(participant, std::string(topics::kAuthority.name))),
        status_(dds::Reader<msg::TaskStatus>::member(participant, std::string(topics::kTaskStatus.name))),
        event_(dds::Reader<msg::TaskEvent>::member(participant, std::string(topics::kTaskEvent.name))) {}
  void take(GoalWatch& watch) const {
    const auto into = [&](const auto& message) { watch.take(message); };
    authority_.take(into);
    status_.take(into);
    event_.take(into);
  }

 private:
  dds::Reader<msg::Authority> authority_;
  dds::Reader<msg::TaskStatus> status_;
  dds::Reader<msg::TaskEvent> event_;
};

/// What `input` answers; kGranted has told nothing yet.
OperatorClient::Answer answer_of_input(OperatorClient& client, std::uint64_t number) {
  const auto answer = client.wait_for_answer(number, kAnswerBound);
  if (answer == OperatorClient::Answer::kRefused) std::fprintf(stderr, "task: refused: %s\n", client.refusal().c_str());
  if (answer == OperatorClient::Answer::kNone) {
    std::fprintf(stderr, "task: no answer within 5 s; is the run paused? It is told as soon as the run goes on\n");
    client.flush();
  }
  return answer;
}

int status_of(OperatorClient::Answer answer) {
  switch (answer) {
    case OperatorClient::Answer::kGranted: return exit_status::kOk;
    case OperatorClient::Answer::kRefused: return exit_status::kMissionFailed;
    case OperatorClient::Answer::kNone: break;
  }
  return exit_status::kWaitedTooLong;
}

int with_client(const Options& options, const std::function<int(OperatorClient&)>& use) {
  OperatorClient client(find_run(options.run).domain, kSource, 0ms, /*detached=*/true);
  if (!client.connect(5s)) {
    std::fprintf(stderr, "task: the run has no `input` that listens\n");
    return exit_status::kWaitedTooLong;
  }
  return use(client);
}

/// The task and its parameters as a request. Throws UsageError.
msg::Request task_request(const Options& options) {
  const auto task = task_by_name(options.name);
  if (!task) throw UsageError(fmt::format("TASK: found '{}', accepted {}", options.name, task_words()));
  msg::Request request{};
  request.kind = msg::kRequestTask;
  request.command = msg::kCommandStart;
  request.task = *task;  // goal_id 0: input numbers it
  request.parameters = no_parameters();
  for (const auto& [key, value] : options.parameters) {
    if (value.empty()) continue;
    const std::string problem = set_task_parameter(request.parameters, key, value);
    if (!problem.empty()) throw UsageError("--" + problem);
  }
  const std::string problem = set_path(request.path, options.path);
  if (!problem.empty()) throw UsageError("--" + problem);
  if ((*task == msg::kTaskFollowPath) != (request.path.point_count > 0)) {
    throw UsageError(*task == msg::kTaskFollowPath ? "follow_path: found no --path, accepted one of 2 to 64 points" : "--path: accepted with follow_path only");
  }
  return request;
}

/// Asks, and waits for both answers: of `input`, which passes the goal on, and of navigation, which may refuse it, too.
int start(const Options& options) {
  const msg::Request request = task_request(options);
  return with_client(options, [&](OperatorClient& client) {
    const GoalReaders readers(client.participant());
    const auto ruled = answer_of_input(client, client.ask(request));
    if (ruled != OperatorClient::Answer::kGranted) return status_of(ruled);
    const std::uint64_t goal = client.goal();
    GoalWatch watch;
    for (const auto limit = Clock::now() + kAnswerBound; Clock::now() < limit; std::this_thread::sleep_for(kPoll)) {
      readers.take(watch);
      const msg::TaskEvent* answer = watch.answer(goal);
      if (!answer) continue;
      if (answer->goal_state == msg::kGoalRefused) {
        std::fprintf(stderr, "task: goal %llu refused: %s\n  authority is yours all the same: `constrictor release` gives it back\n",
                     static_cast<unsigned long long>(goal), answer->detail);
        return exit_status::kMissionFailed;
      }
      fmt::print("{} started, goal {}; `constrictor release` gives authority back\n", task_word(request.task), goal);
      return exit_status::kOk;
    }
    std::fprintf(stderr, "task: goal %llu was passed on, but navigation did not answer within 5 s\n", static_cast<unsigned long long>(goal));
    return exit_status::kWaitedTooLong;
  });
}

/// Stands still: that ends whatever runs.
int cancel(const Options& options) {
  return with_client(options, [](OperatorClient& client) {
    const auto ruled = answer_of_input(client, client.move(msg::kMotionStand));
    if (ruled == OperatorClient::Answer::kGranted) fmt::print("cancelled, the robot stands; `constrictor release` gives authority back\n");
    return status_of(ruled);
  });
}

/// Waits for an event or the end of a goal. What happened to that goal before counts too, so that nothing slips between
/// `task start` and `task wait`; with `--goal any` only what happens from now on counts.
class Waiting {
 public:
  Waiting(const Options& options, std::uint32_t domain)
      : options_(options), event_(*event_by_name(options.end ? "timeout" : options.event)), domain_(domain), participant_(domain), readers_(participant_.participant()) {
    if (options.goal == "any") any_ = true;
    else if (!options.goal.empty()) goal_ = std::stoull(options.goal);
  }

  int run(std::chrono::milliseconds bound) {
    for (const auto begin = Clock::now(); Clock::now() - begin < bound; std::this_thread::sleep_for(kPoll)) {
      readers_.take(watch_);
      if (watch_.epoch() != 0 && !heard_) heard_ = Clock::now();
      // What is kept for late readers has come by then, and with it which goal is the newest.
      if (!heard_ || Clock::now() - *heard_ < kSettle) continue;
      if (epoch_ == 0) from_ = watch_.tick();
      if (epoch_ != 0 && watch_.epoch() != epoch_) {
        if (!any_) return failed("the run was reset");
        from_ = -1;
      }
      epoch_ = watch_.epoch();
      if (!any_ && goal_ == 0) goal_ = watch_.newest();
      if (const auto status = look(Clock::now() - *heard_ > 5 * kSettle)) return *status;
      if (!domain_claimed(domain_)) return failed("the run has ended");
    }
    std::fprintf(stderr, "task: no %s within %s\n", wanted().c_str(), options_.timeout.c_str());
    return exit_status::kWaitedTooLong;
  }

 private:
  [[nodiscard]] std::string wanted() const { return options_.end ? "end" : "\"" + std::string(event_name(event_)) + "\""; }
  [[nodiscard]] int failed(const std::string& why) const {
    std::fprintf(stderr, "task: no %s: %s\n", wanted().c_str(), why.c_str());
    return exit_status::kMissionFailed;
  }
  /// The exit status, if it is known.
  [[nodiscard]] std::optional<int> look(bool patient) const {
    if (!options_.end) {
      const auto* event = any_ ? watch_.event_after(from_, event_) : watch_.event(goal_, event_);
      if (event) {
        fmt::print("{} at {:.2f} s, goal {} {}\n", event_name(event->event), static_cast<double>(event->header.time_ns) * 1e-9, event->goal_id, event->detail);
        return exit_status::kOk;
      }
    }
    const auto end = any_ || goal_ == 0 ? std::nullopt : watch_.end(goal_, patient);
    if (!end) return std::nullopt;
    if (options_.end) {
      fmt::print("{}{}{}\n", goal_state_name(end->state), end->reason.empty() ? "" : ": ", end->reason);
      return end->state == msg::kGoalSucceeded ? exit_status::kOk : exit_status::kMissionFailed;
    }
    // A grasp may be lost after its goal has succeeded; everything else comes before the end.
    if (event_ == msg::kEventObjectGraspLost || !patient) return std::nullopt;
    return failed(fmt::format("goal {} has {}", goal_, goal_state_name(end->state)));
  }

  const Options& options_;
  std::uint8_t event_;
  std::uint32_t domain_;
  dds::Domain participant_;
  GoalReaders readers_;
  GoalWatch watch_;
  bool any_ = false;
  std::uint64_t goal_ = 0;          ///< 0: the next one, as there was none
  std::uint32_t epoch_ = 0;
  std::int64_t from_ = -1;          ///< [tick] after which events of any goal count
  std::optional<Clock::time_point> heard_;
};

int wait(const Options& options) {
  if (!options.end && !event_by_name(options.event)) {
    throw UsageError(fmt::format("--event: found '{}', accepted {}", options.event, event_words()));
  }
  if (options.goal == "any" && options.end) throw UsageError("--goal: found 'any', accepted a goal's number together with --end");
  const auto bound = parse_duration("--timeout", options.timeout);
  return Waiting(options, find_run(options.run).domain).run(bound);
}

int list() {
  for (std::uint8_t task = 1; task < msg::kTaskCount; ++task) fmt::print("task   {}\n", task_word(task));
  for (std::uint8_t event = 1; event < msg::kEventCount; ++event) fmt::print("event  {}\n", event_name(event));
  return exit_status::kOk;
}

}  // namespace

std::chrono::milliseconds parse_duration(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const double factor = unit == "ms" ? 1e-3 : unit.empty() || unit == "s" ? 1.0 : unit == "m" ? 60.0 : unit == "h" ? 3600.0 : 0.0;
  if (end == text.c_str() || factor == 0.0 || !(value > 0.0 && value * factor <= 1e6)) {
    throw UsageError(fmt::format("{}: found '{}', accepted a duration such as 5s, 500ms, 2m", option, text));
  }
  return std::chrono::milliseconds(std::llround(1e3 * value * factor));
}

void add_task(CLI::App& app, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  auto* task = app.add_subcommand("task", "start, cancel and await tasks from a script");
  task->require_subcommand(1);
  const std::string about =
      "Tasks are the paper's (Tables I to XV), and follow_path. A script asks as an operator: it takes authority from the planner, and\n"
      "keeps it until `constrictor release`.";
  task->footer(help_footer(about,
                           {"constrictor task start rotate --direction left --timeout-s 5", "constrictor task wait --end && constrictor release",
                            "constrictor task wait --event \"object found\" --goal any      # whoever's goal it is"},
                           fmt::format("0 done; 1 refused, or it ended otherwise than well; {};\n  75 no answer, or too late", kRunStatuses)));
  const auto add = [&](const char* name, const char* text, std::function<int()> what) {
    auto* sub = task->add_subcommand(name, text);
    sub->callback([&action, what = std::move(what)] { action = what; });
    return sub;
  };
  const auto of_run = [&](CLI::App* sub) {
    add_run_option(*sub, options->run);
    return sub;
  };
  auto* start_app = of_run(add("start", "start a task as an operator; authority stays until `constrictor release`", [options] { return start(*options); }));
  start_app->add_option("TASK", options->name, task_words())->required();
  const std::string colours = colour_words();
  for (const auto& [name, text] : std::initializer_list<std::pair<const char*, std::string>>{
           {"line-colour", "of follow_line: " + colours},
           {"object-colour", "of search_object, track_object, pregrasp: " + colours},
           {"object-handle", "of search_object, track_object, pregrasp: which object of that colour, 1 to 65535 (default: any)"},
           {"drop-zone-colour", "of drop: " + colours},
           {"direction", "of rotate: left, right; of explore: " + direction_words()},
           {"timeout-s", "[s] of rotate: end it after so long, simulated time, up to 3600 (default: turn until something else is asked)"}}) {
    start_app->add_option(std::string("--") + name, options->parameters[name], text);
  }
  start_app->add_option("--path", options->path, "of follow_path: 2 to 64 points X,Y in m on the map: from where the robot began, x ahead and y left; passing within 1 m of it")
      ->expected(2, static_cast<int>(msg::kMaxPathPoints))->option_text("X,Y X,Y...");
  start_app->footer(help_footer("Waits for the answers of `input` and navigation, and names the goal. Where the robot is on the map of --path:\n"
                                "`constrictor topic echo guidance/pose --count 1`.",
                                {"constrictor task start follow_line --line-colour blue", "constrictor task start explore --direction forwards",
                                 "constrictor task start follow_path --path 0,0 1,0 2,0.5"},
                                fmt::format("0 it has begun; 1 refused, with the reason; {};\n  75 no answer within 5 s", kRunStatuses)));
  of_run(add("cancel", "end what runs and stand still; authority stays until `constrictor release`", [options] { return cancel(*options); }))
      ->footer(help_footer("", {"constrictor task cancel && constrictor release"},
                           fmt::format("0 cancelled; 1 refused; {}; 75 no answer within 5 s", kRunStatuses)));
  auto* wait_app = of_run(add("wait", "wait for an event of a goal, or for its end", [options] { return wait(*options); }));
  auto* what = wait_app->add_option_group("what");
  what->add_option("--event", options->event, event_words());
  what->add_flag("--end", options->end, "the goal's end");
  what->require_option(1);
  wait_app->add_option("--goal", options->goal, "a goal by the number that `task start` told, or any: events of all goals from now on (default: the newest)")
      ->check([](const std::string& text) { return text == "any" ? std::string{} : whole_number()(text); });
  wait_app->add_option("--timeout", options->timeout, "wall time: 60s, 2m")->capture_default_str();
  wait_app->footer(help_footer("What happened to the goal before this command counts, too: nothing slips between `task start` and `task wait`.",
                               {"constrictor task wait --end", "constrictor task wait --event \"line lost\" --timeout 2m",
                                "constrictor task wait --event \"object grasped\" --goal any"},
                               fmt::format("0 it came, or the goal succeeded; 1 the goal ended without it or did not succeed, or the run ended;\n"
                                           "  {}; 75 too late", kRunStatuses)));
  add("list", "the tasks and events there are", list)->footer("EXAMPLES\n  constrictor task list\n\nEXIT STATUS\n  0 done; 64 wrong usage\n\n"
                                                                  "ENVIRONMENT\n  none: it asks no run");
}

}  // namespace constrictor::cli
