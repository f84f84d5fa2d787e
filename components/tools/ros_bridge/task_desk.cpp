#include "ros_bridge/task_desk.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "client/request_client.hpp"
#include "client/task_names.hpp"
#include "component/task_parameters.hpp"
#include "constrictor/constants.hpp"
#include "constrictor/json.hpp"
#include "constrictor/text.hpp"

namespace constrictor::ros_bridge {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::chrono::seconds kLate{5};

}  // namespace

std::variant<TaskLine, std::string> parse_task_line(const std::string& line) {
  if (line.size() > kLongestTaskLine)
    return fmt::format("found {} characters, accepted at most {}", line.size(), kLongestTaskLine);
  using Kind = TaskLine::Kind;
  TaskLine what;
  for (const auto& [word, kind] :
       {std::pair{"cancel", Kind::kCancel}, std::pair{"take", Kind::kTake}, std::pair{"release", Kind::kRelease}}) {
    if (line != word) continue;
    what.kind = kind;
    return what;
  }
  std::uint8_t task = msg::kTaskNone;
  msg::Request request = task_request(task);
  std::string problem = parse_task(line, task, request.parameters, request.path);
  if (problem.empty()) problem = task_parameter_refusal(task, request.parameters, request.path);
  if (!problem.empty()) return printable(problem) + "; also accepted: cancel, take, release";
  request.task = task;
  what.request = request;
  return what;
}

void TaskDesk::say(const Entry& entry, const std::string& state, const std::string& reason) {
  answers_.push_back(
      json_text(Json{{"request", entry.line}, {"state", state}, {"goal", entry.goal}, {"reason", reason}}));
}

void TaskDesk::refuse(const std::string& line, const std::string& reason) {
  ++refused_;
  last_reason_ = reason;
  Entry entry;
  entry.line = printable(line.substr(0, 200));
  say(entry, "refused", reason);
}

void TaskDesk::sent(const std::string& line, const TaskLine& what, std::uint64_t number, Time now) {
  Entry entry;
  entry.line = printable(line);
  entry.kind = what.kind;
  entry.number = number;
  entry.sent = now;
  entries_.push_back(std::move(entry));
}

std::vector<std::uint64_t> TaskDesk::waiting() const {
  std::vector<std::uint64_t> numbers;
  for (const Entry& entry : entries_) {
    if (entry.number != 0) numbers.push_back(entry.number);
  }
  return numbers;
}

void TaskDesk::answered(const msg::RequestAnswer& answer) {
  const auto at = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return entry.number != 0 && entry.number == answer.request_sequence;
  });
  if (at == entries_.end()) return;
  Entry entry = *at;
  entry.number = 0;
  if (!answer.granted) {
    entries_.erase(at);
    return refuse(entry.line, printable(text_of(answer.reason)));
  }
  entry.goal = answer.goal_id;
  keeps_ = entry.kind == TaskLine::Kind::kTake || (keeps_ && entry.kind != TaskLine::Kind::kRelease);
  if (entry.kind == TaskLine::Kind::kStart && entry.goal != 0) {
    *at = entry;  // navigation still has to accept the goal
    return;
  }
  say(entry, "granted");
  entries_.erase(at);
}

void TaskDesk::look(const GoalTracker& goals, Time now) {
  const bool reset = epoch_ != 0 && goals.epoch() > epoch_;
  epoch_ = goals.epoch();
  if (reset) {  // its goals are gone, and no message says so
    for (const Entry& entry : entries_) {
      if (entry.goal != 0) say(entry, "aborted", "the run was reset");
    }
    std::erase_if(entries_, [](const Entry& entry) { return entry.goal != 0; });
    keeps_ = false;
  }
  for (auto at = entries_.begin(); at != entries_.end();) {
    if (at->goal == 0) {
      if (!at->late && now - at->sent > kLate) {
        at->late = true;
        say(*at, "unanswered", "the run has not answered for 5 s; it may be paused, or `input` may be gone");
      }
      ++at;
      continue;
    }
    const msg::TaskEvent* first = goals.answer(at->goal);
    const auto end = goals.end(at->goal, /*by_status=*/true);
    if (first && first->goal_state == msg::kGoalRefused) {
      refuse(at->line, printable(text_of(first->detail)));
      at = entries_.erase(at);
      continue;
    }
    if (!at->runs && (first || end)) {
      at->runs = true;
      say(*at, "running");
    }
    if (!end) {
      ++at;
      continue;
    }
    say(*at, name_of(constants::kGoal, end->state), printable(end->reason));
    at = entries_.erase(at);
  }
}

bool TaskDesk::busy() const {
  return std::any_of(entries_.begin(), entries_.end(),
                     [](const Entry& entry) { return entry.kind == TaskLine::Kind::kStart; });
}

std::vector<std::string> TaskDesk::answers() { return std::exchange(answers_, {}); }

std::string task_status_json(const msg::TaskStatus& status) {
  return json_text(Json{{"goal", status.goal_id},
                        {"task", name_of(constants::kTask, status.task)},
                        {"state", name_of(constants::kGoal, status.goal_state)},
                        {"phase", printable(text_of(status.phase))},
                        {"progress", status.progress},
                        {"carrying", status.carrying},
                        {"reason", printable(text_of(status.reason))}});
}

std::string task_event_json(const msg::TaskEvent& event) {
  return json_text(Json{{"time_s", static_cast<double>(event.header.time_ns) / 1e9},
                        {"goal", event.goal_id},
                        {"task", name_of(constants::kTask, event.task)},
                        {"event", name_of(constants::kEvent, event.event)},
                        {"goal_state", name_of(constants::kGoal, event.goal_state)},
                        {"colour", name_of(constants::kColour, event.colour)},
                        {"object", event.object_handle},
                        {"detail", printable(text_of(event.detail))}});
}

}  // namespace constrictor::ros_bridge
