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

#include "cli/operator_client.hpp"
#include "cli/run_registry.hpp"
#include "cli/task_names.hpp"
#include "configuration/configuration.hpp"
#include "runtime/dds/domain.hpp"
#include "runtime/dds/endpoint.hpp"
#include "runtime/host.hpp"
#include "runtime/topics.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
constexpr auto kPoll = 10ms;
/// One source for all scripts of a run: what one started another may cancel.
constexpr const char* kSource = "task";

struct Options {
  std::optional<std::uint32_t> run;
  std::string name;
  std::map<std::string, std::string> parameters;
  std::string event;
  bool end = false;
  std::string timeout = "60s";
};

int answered(OperatorClient& client, std::uint64_t number, const std::string& granted) {
  switch (client.wait_for_answer(number, 5s)) {
    case OperatorClient::Answer::kGranted: fmt::print("{}\n", granted); return exit_status::kOk;
    case OperatorClient::Answer::kRefused: std::fprintf(stderr, "task: refused: %s\n", client.refusal().c_str()); return exit_status::kMissionFailed;
    case OperatorClient::Answer::kNone: break;
  }
  std::fprintf(stderr, "task: no answer within 5 s; is the run paused?\n");
  client.flush();
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

int start(const Options& options) {
  const auto task = task_by_name(options.name);
  if (!task) throw ConfigurationError(fmt::format("TASK: found '{}', accepted one of `constrictor task list`", options.name));
  msg::TaskParameters parameters = no_parameters();
  for (const auto& [key, value] : options.parameters) {
    if (value.empty()) continue;
    const std::string problem = set_task_parameter(parameters, key, value);
    if (!problem.empty()) throw ConfigurationError("--" + problem);
  }
  return with_client(options, [&](OperatorClient& client) {
    return answered(client, client.start(*task, parameters), fmt::format("{} started; `constrictor release` gives authority back", task_word(*task)));
  });
}

/// Stands still: that ends whatever runs.
int cancel(const Options& options) {
  return with_client(options, [](OperatorClient& client) { return answered(client, client.move(msg::kMotionStand), "cancelled"); });
}

/// Waits for an event or the end of the newest goal. What happened to that goal before counts too, so that nothing slips between
/// `task start` and `task wait`.
int wait(const Options& options) {
  const auto event = options.end ? std::optional<std::uint8_t>(msg::kEventNone) : event_by_name(options.event);
  if (!event) throw ConfigurationError(fmt::format("--event: found '{}', accepted an event of `constrictor task list`", options.event));
  const auto bound = parse_duration("--timeout", options.timeout);
  const dds::Domain domain(find_run(options.run).domain);
  const auto events = dds::Reader<msg::TaskEvent>::member(domain.participant(), std::string(topics::kTaskEvent.name));
  const auto statuses = dds::Reader<msg::TaskStatus>::member(domain.participant(), std::string(topics::kTaskStatus.name));
  const auto limit = Clock::now() + bound;
  std::optional<std::uint64_t> goal;
  std::vector<msg::TaskEvent> seen;
  for (std::optional<std::uint8_t> ended; Clock::now() < limit; std::this_thread::sleep_for(kPoll)) {
    statuses.take([&](const msg::TaskStatus& status) {
      if (!goal) goal = status.goal_id;
    });
    events.take([&](const msg::TaskEvent& e) { seen.push_back(e); });
    if (!goal) continue;  // what runs is not known yet
    for (const auto& e : std::exchange(seen, {})) {
      if (e.goal_id != *goal && (e.goal_id >> 48) == (*goal >> 48) && e.goal_id < *goal) continue;  // of an earlier goal
      if (!options.end && e.event == *event) {
        fmt::print("{} at {:.2f} s {}\n", event_name(e.event), static_cast<double>(e.header.time_ns) * 1e-9, e.detail);
        return exit_status::kOk;
      }
      if (e.goal_id == *goal && e.event == msg::kEventNone && e.goal_state >= msg::kGoalSucceeded) ended = e.goal_state;
    }
    if (options.end && ended) {
      fmt::print("{}\n", goal_state_name(*ended));
      return *ended == msg::kGoalSucceeded ? exit_status::kOk : exit_status::kMissionFailed;
    }
  }
  std::fprintf(stderr, "task: no %s within %s\n", options.end ? "end" : options.event.c_str(), options.timeout.c_str());
  return exit_status::kWaitedTooLong;
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
    throw ConfigurationError(fmt::format("{}: found '{}', accepted a duration such as 5s, 500ms, 2m", option, text));
  }
  return std::chrono::milliseconds(std::llround(1e3 * value * factor));
}

void add_task(CLI::App& app, std::function<int()>& action) {
  const auto options = std::make_shared<Options>();
  auto* task = app.add_subcommand("task", "start, cancel and await tasks from a script");
  task->require_subcommand(1);
  const auto add = [&](const char* name, const char* text, std::function<int()> what) {
    auto* sub = task->add_subcommand(name, text);
    sub->callback([&action, what = std::move(what)] { action = what; });
    return sub;
  };
  const auto of_run = [&](CLI::App* sub) {
    sub->add_option("--run", options->run, "the run, by its DDS domain (default: the only one there is)")->envname("CONSTRICTOR_DOMAIN");
    return sub;
  };
  auto* start_app = of_run(add("start", "start a task as an operator; authority stays until `constrictor release`", [options] { return start(*options); }));
  start_app->add_option("TASK", options->name, "follow_line, search_object, ... (`constrictor task list`)")->required();
  for (const char* name : {"line-colour", "object-colour", "object-handle", "drop-zone-colour", "direction", "timeout-s"}) {
    start_app->add_option(std::string("--") + name, options->parameters[name], "parameter of the task (Tables I to XV)");
  }
  of_run(add("cancel", "end what runs and stand still", [options] { return cancel(*options); }));
  auto* wait_app = of_run(add("wait", "wait for an event of the newest goal (75 if it does not come), or for its end (1 unless it succeeds)",
                              [options] { return wait(*options); }));
  auto* what = wait_app->add_option_group("what");
  what->add_option("--event", options->event, "\"line lost\", \"object grasped\", ... (`constrictor task list`)");
  what->add_flag("--end", options->end, "the goal's end");
  what->require_option(1);
  wait_app->add_option("--timeout", options->timeout, "wall time: 60s, 2m")->capture_default_str();
  add("list", "the tasks and events there are", list);
}

}  // namespace constrictor::cli
