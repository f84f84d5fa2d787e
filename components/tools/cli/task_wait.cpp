#include "cli/task_wait.hpp"

#include <fmt/format.h>

#include <cctype>
#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/task_command.hpp"
#include "cli/task_request.hpp"
#include "cli/usage.hpp"
#include "client/goal_reader.hpp"
#include "client/polling.hpp"
#include "client/run_registry.hpp"
#include "client/task_names.hpp"
#include "common/interrupt.hpp"
#include "configuration/closest_name.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "constrictor/text.hpp"
#include "cyclone/domain.hpp"
#include "cyclone/domain_claim.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::ordered_json;
/// After this time all messages that writers keep for late readers have arrived.
constexpr auto kSettle = 200ms;
/// After this time the event of a goal's end is regarded as lost, and a TaskStatus also proves the end.
constexpr auto kEventLost = 1s;

class Waiting {
 public:
  Waiting(const TaskWaitOptions& options, std::uint32_t domain)
      : options_(options),
        event_(options.end ? msg::kEventNone : *event_by_name(options.event)),
        domain_(domain),
        participant_(domain),
        reader_(participant_.participant()),
        any_(options.goal == "any") {}

  int run(std::chrono::milliseconds bound) {
    catch_interrupts();
    for (const auto begin = WaitClock::now(); WaitClock::now() - begin < bound; std::this_thread::sleep_for(kPoll)) {
      if (interrupt_signal() != 0) {
        std::fprintf(stderr,
                     "task: interrupted; the goal goes on, and authority has not changed (`constrictor task "
                     "cancel` ends the goal)\n");
        return interrupt_status();
      }
      reader_.poll();
      if (goals().epoch() != 0 && !heard_) heard_ = WaitClock::now();
      if (!heard_ || WaitClock::now() - *heard_ < kSettle) continue;
      if (epoch_ == 0) from_ = goals().tick();
      if (epoch_ != 0 && goals().epoch() != epoch_) {
        if (!any_) return failed("the run was reset");
        from_ = -1;
      }
      epoch_ = goals().epoch();
      if (!any_ && goal_ == 0)
        goal_ = options_.goal.empty() ? goals().newest() : goals().find(std::stoull(options_.goal));
      if (const auto status = look(WaitClock::now() - *heard_ > kEventLost)) return *status;
      if (!domain_claimed(domain_)) return failed("the run has ended");
    }
    print_failure("too_late",
                  fmt::format("no {} within {}{}", wanted(), options_.timeout,
                              std::isdigit(static_cast<unsigned char>(options_.timeout.back())) ? " s" : ""));
    return exit_status::kWaitedTooLong;
  }

 private:
  [[nodiscard]] const GoalTracker& goals() const { return reader_.goals(); }
  [[nodiscard]] std::string wanted() const {
    const std::string what = options_.end ? "end" : fmt::format("\"{}\"", event_name(event_));
    return goal_ == 0 ? what : fmt::format("{} of goal {}", what, goal_text(goal_));
  }
  [[nodiscard]] int failed(const std::string& why) const {
    print_failure("ended", fmt::format("no {}: {}", wanted(), why));
    return exit_status::kFailed;
  }
  /// `result`: what happened, for scripts.
  void print_failure(const char* result, const std::string& reason) const {
    std::fprintf(stderr, "task: %s\n", reason.c_str());
    if (!options_.json) return;
    Json json = {{"result", result}};
    if (goal_ != 0) json["goal"] = goal_number(goal_);
    json["reason"] = reason;
    fmt::print("{}\n", json_text(json));
  }
  void print(const msg::TaskEvent& event) const {
    const double time_s = static_cast<double>(event.header.time_ns) * 1e-9;
    if (!options_.json) {
      fmt::print("{} at {:.2f} s, goal {} {}\n", event_name(event.event), time_s, goal_text(event.goal_id),
                 event.detail);
      return;
    }
    const Json json = {
        {"result", "event"},        {"event", event_name(event.event)}, {"goal", goal_number(event.goal_id)},
        {"goal_id", event.goal_id}, {"task", task_word(event.task)},    {"tick", event.header.tick},
        {"sim_time_s", time_s},     {"detail", text_of(event.detail)}};
    fmt::print("{}\n", json_text(json));
  }
  void print(const GoalTracker::End& end) const {
    const Json json = {{"result", "end"},
                       {"state", goal_state_name(end.state)},
                       {"goal", goal_number(goal_)},
                       {"goal_id", goal_},
                       {"reason", end.reason}};
    if (options_.json) fmt::print("{}\n", json_text(json));
    else fmt::print("{}{}{}\n", goal_state_name(end.state), end.reason.empty() ? "" : ": ", end.reason);
  }
  /// The exit status, if the wait is over. `status_counts`: navigation's TaskStatus proves the end of a goal.
  [[nodiscard]] std::optional<int> look(bool status_counts) const {
    if (!options_.end) {
      const auto* event = any_ ? goals().event_after(from_, event_) : goals().event(goal_, event_);
      if (event) {
        print(*event);
        return exit_status::kOk;
      }
    }
    const auto end = any_ || goal_ == 0 ? std::nullopt : goals().end(goal_, status_counts);
    if (!end) return std::nullopt;
    if (options_.end) {
      print(*end);
      return end->state == msg::kGoalSucceeded ? exit_status::kOk : exit_status::kFailed;
    }
    // A grasp may be lost after its goal has succeeded. Every other event of a goal comes before its end.
    if (event_ == msg::kEventObjectGraspLost || !status_counts) return std::nullopt;
    return failed(fmt::format("it has {}", goal_state_name(end->state)));
  }

  const TaskWaitOptions& options_;
  std::uint8_t event_;
  std::uint32_t domain_;
  dds::Domain participant_;
  GoalReader reader_;
  bool any_;
  std::uint64_t goal_ = 0;  ///< 0: the goal does not exist yet, or any goal is accepted
  std::uint32_t epoch_ = 0;
  std::int64_t from_ = -1;  ///< tick after which events of any goal count
  std::optional<WaitClock::time_point> heard_;
};

}  // namespace

int task_wait(const TaskWaitOptions& options, std::optional<std::uint32_t> run) {
  if (!options.end && !event_by_name(options.event))
    throw UsageError(fmt::format("--event: found '{}', accepted {}{}", options.event, event_words(),
                                 did_you_mean(options.event, names_of(constants::kEvent, 1))));
  if (options.goal == "any" && options.end)
    throw UsageError("--goal: found 'any', accepted a goal's number together with --end");
  const auto bound = parse_duration("--timeout", options.timeout);
  return Waiting(options, join_run(run).domain).run(bound);
}

}  // namespace constrictor::cli
