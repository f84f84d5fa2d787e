#include "cli/task_command.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "cli/subcommands.hpp"
#include "cli/task_request.hpp"
#include "cli/task_wait.hpp"
#include "cli/usage.hpp"
#include "client/goal_tracker.hpp"
#include "client/run_registry.hpp"
#include "client/task_names.hpp"
#include "common/interrupt.hpp"
#include "common/operator.hpp"
#include "component/task_parameters.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
/// All scripts of a run share one source, so that one script can cancel what another one started.
constexpr const char* kSource = "task";

struct TaskOptions {
  std::optional<std::uint32_t> run;
  std::string name;
  std::map<std::string, std::string> parameters;
  std::vector<std::string> path;  ///< points "X,Y"
  TaskWaitOptions wait;
  bool has_planner = true;  ///< the run may have the built-in planner
};

void print_json(const Json& json) { fmt::print("{}\n", json_text(json)); }

/// The output of `task NAME --json` if nothing was done.
void print_nothing_done(const std::string& name, const std::string& why) {
  Json nothing = {{"result", "error"}};
  if (name == "start") nothing = {{"started", nullptr}};
  if (name == "cancel") nothing = {{"cancelled", false}};
  nothing["reason"] = why;
  print_json(nothing);
}

/// Runs `use` for `task NAME`.
int with_client(const std::string& name, const TaskOptions& options, int (*use)(RequestClient&, const TaskOptions&)) {
  const RunNote run = join_run(options.run);
  RequestClient client(run.domain, operator_options(kSource, 0ms, /*detached=*/true));
  std::string reason;
  if (const int status = connect(client, "task", &reason); status != exit_status::kOk) {
    if (options.wait.json) print_nothing_done(name, reason);
    return status;
  }
  TaskOptions known = options;
  known.has_planner = run.roster.empty() || std::find(run.roster.begin(), run.roster.end(),
                                                      topics::kPlannerRequest.writer) != run.roster.end();
  return use(client, known);
}

/// Runs `task NAME`. With --json, a script reads from standard output why nothing was done, also after wrong usage and
/// if there is no run.
int with_json(const std::string& name, bool json, const std::function<int()>& what) {
  try {
    return what();
  } catch (const std::exception& error) {
    if (json) print_nothing_done(name, error.what());
    throw;  // main() prints it, and knows the exit status
  }
}

/// The task and its parameters as a request. Throws UsageError if they are wrong or incomplete: such a request must not
/// be sent, because it would end the running mission.
msg::Request request_of(const TaskOptions& options) {
  const auto task = task_by_name(options.name);
  if (!task)
    throw UsageError(fmt::format("TASK: found '{}', accepted {}{}", options.name, task_words(),
                                 did_you_mean(options.name, names_of(constants::kTask, 1))));
  msg::Request request = task_request(*task);
  for (const auto& [key, value] : options.parameters) {
    if (value.empty()) continue;
    const std::string problem = set_task_parameter(request.parameters, key, value);
    if (!problem.empty()) throw UsageError("--" + problem);
  }
  std::string problem = set_path(request.path, options.path);
  if (!problem.empty()) throw UsageError("--" + problem);
  problem = request_refusal(request);
  if (!problem.empty()) {
    const char* option = *task == msg::kTaskFollowPath ? "--path X,Y X,Y; " : "";
    throw UsageError(fmt::format("{} ({}constrictor task start --help)", problem, option));
  }
  return request;
}

/// Ends an interrupted `task start`: releases authority, so that no task begins after this command has ended.
int give_back(RequestClient& client) {
  if (client.release(2s)) {
    std::fprintf(stderr, "task: interrupted; the task was cancelled and authority released\n");
  } else {
    client.flush();
    std::fprintf(stderr,
                 "task: interrupted; the run does not answer. If it is paused it starts the task and releases "
                 "authority as soon as it resumes; see `constrictor status`\n");
  }
  return interrupt_status();
}

/// Waits for the answers of `input`, which forwards the goal, and of navigation, which may refuse it.
int start(RequestClient& client, const TaskOptions& options) {
  const msg::Request request = request_of(options);
  const bool held = client.holds_authority();
  // If nobody has authority beside the built-in planner, it waits after an emergency stop until a source releases it.
  const bool planner_waits =
      options.has_planner && client.authority() && client.authority()->level == msg::kAuthorityNone;
  try {
    const std::uint64_t goal = client.start_goal(request);
    if (options.wait.json)
      print_json({{"started", task_word(request.task)}, {"goal", goal_number(goal)}, {"goal_id", goal}});
    else
      fmt::print("{} started, goal {}; `constrictor release` gives authority back\n", task_word(request.task),
                 goal_text(goal));
    return exit_status::kOk;
  } catch (const CommandError& error) {
    if (error.cause() == CommandError::Cause::kInterrupted) return give_back(client);
    std::fprintf(stderr, "task: %s\n", error.what());
    if (options.wait.json) print_json({{"started", nullptr}, {"reason", error.what()}});
    // Navigation refuses what the robot cannot do now, after `input` has given authority to this command. The grant
    // proves it: the message with the new authority may arrive later than navigation's refusal.
    const bool took = !held && client.goal() != 0;
    if (took && planner_waits && error.cause() == CommandError::Cause::kRefused) {
      std::fprintf(stderr,
                   "  nobody had authority; this script keeps it, so that the robot stands: after `constrictor "
                   "release` the planner goes on\n");
    } else if (took && error.cause() == CommandError::Cause::kRefused) {
      std::fprintf(stderr, client.release(2s)
                               ? "  authority was released: a planner may take it again\n"
                               : "  authority is still with this script; `constrictor release` gives it back\n");
    }
    client.flush();
    return error.cause() == CommandError::Cause::kRefused ? exit_status::kFailed : exit_status::kWaitedTooLong;
  }
}

/// Makes the robot stand. This ends the running task.
int cancel(RequestClient& client, const TaskOptions& options) {
  const auto answer = client.wait_for_answer(client.move(msg::kMotionStand), 5s);
  const bool granted = answer == RequestClient::Answer::kGranted;
  const std::string why = answer == RequestClient::Answer::kRefused ? client.refusal()
                          : answer == RequestClient::Answer::kNone  ? "no answer within 5 s"
                                                                    : "interrupted before the answer";
  if (options.wait.json) print_json({{"cancelled", granted}, {"reason", granted ? "" : why}});
  else if (granted) fmt::print("cancelled, the robot stands; `constrictor release` gives authority back\n");
  return report_not_granted(client, answer, "task");
}

int list_tasks(const TaskOptions& options) {
  if (options.wait.json) {
    Json tasks = Json::array();
    Json events = Json::array();
    for (std::uint8_t task = 1; task < msg::kTaskCount; ++task) tasks.push_back(task_word(task));
    for (std::uint8_t event = 1; event < msg::kEventCount; ++event) events.push_back(event_name(event));
    print_json({{"tasks", tasks}, {"events", events}});
    return exit_status::kOk;
  }
  for (std::uint8_t task = 1; task < msg::kTaskCount; ++task) fmt::print("task   {}\n", task_word(task));
  for (std::uint8_t event = 1; event < msg::kEventCount; ++event) fmt::print("event  {}\n", event_name(event));
  return exit_status::kOk;
}

}  // namespace

std::chrono::milliseconds parse_duration(const std::string& option, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  const double factor = unit == "ms"                  ? 1e-3
                        : unit.empty() || unit == "s" ? 1.0
                        : unit == "m"                 ? 60.0
                        : unit == "h"                 ? 3600.0
                                                      : 0.0;
  if (end == text.c_str() || factor == 0.0 || !(value > 0.0 && value * factor <= 1e6)) {
    throw UsageError(
        fmt::format("{}: found '{}', accepted a duration such as 5s, 500ms, 2m, at most 1000000s", option, text));
  }
  return std::chrono::milliseconds(std::llround(1e3 * value * factor));
}

void add_task(CLI::App& app, Action& action) {
  const auto options = std::make_shared<TaskOptions>();
  auto* task = add_group(app, "task", "start, cancel and wait for tasks from a script");
  task->footer(help_footer(
      "The tasks are those of the paper (Tables I to XV), and follow_path. A script has the level of an operator: it "
      "takes authority from the\nplanner and keeps it until `constrictor release`.",
      {"constrictor task start rotate --direction left --timeout-s 5",
       "constrictor task wait --end && constrictor release",
       "constrictor task wait --event \"object found\" --goal any      # of any goal, also the planner's"},
      fmt::format("0 done; 1 refused, or the goal did not succeed; {};\n  75 no answer, or too late; 130 interrupted "
                  "by Ctrl-C",
                  kRunStatuses)));
  const auto add = [&](const char* name, const char* text, std::function<int()> what) {
    auto* sub = task->add_subcommand(name, text);
    sub->callback([&action, options, name, what = std::move(what)] {
      action = [=] { return with_json(name, options->wait.json, what); };
    });
    sub->add_flag("--json", options->wait.json, "print the result as one JSON object, also a refusal");
    return sub;
  };
  const auto of_run = [&](CLI::App* sub) {
    add_run_option(*sub, options->run);
    return sub;
  };
  auto* start_app =
      of_run(add("start", "start a task as an operator; authority stays until `constrictor release`", [options] {
        static_cast<void>(request_of(*options));  // reports wrong usage even if there is no run
        return with_client("start", *options, start);
      }));
  start_app->add_option("TASK", options->name, task_words())->required();
  const std::string colours = colour_words();
  for (const auto& [name, text] : std::initializer_list<std::pair<const char*, std::string>>{
           {"line-colour", "of follow_line: " + colours},
           {"object-colour", "of search_object, track_object, pregrasp: " + colours},
           {"object-handle",
            "of search_object, track_object, pregrasp: which object of that colour, 1 to 65535 (default: any)"},
           {"drop-zone-colour", "of drop: " + colours},
           {"direction", "of rotate: left, right; of explore: " + direction_words() +
                             "; of pregrasp: the side of the object, left or right (default: the nearer with room)"},
           {"timeout-s",
            "[s] of any task: rotate ends after this simulated time, every other task is aborted (default: no limit)"},
           {"clearance-m",
            "[m] of pregrasp: between body and object while the body passes it, up to 1 (default: usual)"},
           {"wrap-scale", "of grasp: width of the open U relative to the usual one for the object (default: 1)"}}) {
    start_app->add_option(std::string("--") + name, options->parameters[name], text);
  }
  start_app
      ->add_option("--path", options->path,
                   fmt::format("[m] of follow_path: 2 to {} points X,Y on the map, x ahead and y left of the robot's "
                               "first position; the path must pass within 1 m of the robot",
                               msg::kMaxPathPoints))
      ->expected(2, static_cast<int>(msg::kMaxPathPoints))
      ->option_text("X,Y X,Y...");
  start_app->footer(help_footer(
      "Waits for the answers of `input` and navigation, and prints the goal's number. Where the robot is on the map:\n"
      "`constrictor topic echo guidance/pose --count 1`. A task that is refused leaves authority as it was; "
      "if nobody had it\nbeside a planner, as after an emergency stop, the script keeps it. Ctrl-C before the answers "
      "cancels the task and\nreleases authority.",
      {"constrictor task start follow_line --line-colour blue", "constrictor task start explore --direction forwards",
       "constrictor task start rotate --direction left --json",
       "constrictor task start follow_path --path 0,0 1,0 2,0.5"},
      fmt::format(
          "0 the task has begun; 1 refused, with the reason; {};\n  75 no answer within 5 s; 130 interrupted by "
          "Ctrl-C",
          kRunStatuses)));
  of_run(add("cancel", "end the task that runs and stand still; authority stays until `constrictor release`",
             [options] { return with_client("cancel", *options, cancel); }))
      ->footer(help_footer("", {"constrictor task cancel && constrictor release"},
                           fmt::format("0 cancelled; 1 refused; {}; 75 no answer within 5 s;\n  130 interrupted by "
                                       "Ctrl-C",
                                       kRunStatuses)));
  auto* wait_app = of_run(add("wait", "wait for an event of a goal, or for its end",
                              [options] { return task_wait(options->wait, options->run); }));
  auto* what = wait_app->add_option_group("what");
  what->add_option("--event", options->wait.event, event_words());
  what->add_flag("--end", options->wait.end, "wait for the end of the goal");
  what->require_option(1);
  wait_app
      ->add_option("--goal", options->wait.goal,
                   "the number of a goal, as `task start` prints it, or any: events of all goals from now on (default: "
                   "the newest goal)")
      ->check([](const std::string& text) { return text == "any" ? std::string{} : whole_number()(text); });
  wait_app->add_option("--timeout", options->wait.timeout, "longest wait, in wall time: 60s, 2m")
      ->capture_default_str();
  wait_app->footer(help_footer(
      "Events of the goal that happened before this command count too: none is missed between `task start` and `task "
      "wait`.\nAuthority does not change, also at Ctrl-C.",
      {"constrictor task wait --end", "constrictor task wait --event \"line lost\" --timeout 2m",
       "constrictor task wait --event \"object grasped\" --goal any"},
      fmt::format("0 the event came, or the goal succeeded; 1 the goal ended without it or did not succeed, or the run "
                  "ended;\n  {}; 75 too late; 130 interrupted by Ctrl-C",
                  kRunStatuses)));
  add("list", "list the tasks and events", [options] { return list_tasks(*options); })
      ->footer(
          "EXAMPLES\n  constrictor task list\n\nEXIT STATUS\n  0 done; 64 wrong usage\n\n"
          "ENVIRONMENT\n  none: it joins no run");
}

}  // namespace constrictor::cli
