// Tasks that ROS programs request by a line of text, and the answers to them.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "client/goal_tracker.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::ros_bridge {

/// Longer lines are refused: a path of 64 points fits.
inline constexpr std::size_t kLongestTaskLine = 2000;
/// More requests than these may not wait for their answers.
inline constexpr std::size_t kMostWaitingTasks = 16;

/// The request in a line.
struct TaskLine {
  enum class Kind { kStart, kCancel, kTake, kRelease } kind = Kind::kStart;
  msg::Request request{};  ///< of a start
};

/// Reads "follow_line line_colour=blue", "cancel", "take" or "release". Returns the request, or the problem as text.
[[nodiscard]] std::variant<TaskLine, std::string> parse_task_line(const std::string& line);

/// Remembers which requests of ROS programs have no answer yet and which of their goals still run, and writes the
/// answers as JSON: {"request": "...", "state": "...", "goal": N, "reason": "..."}. Pure: no DDS, time is an argument.
///
/// The states are `refused`, `unanswered` (no answer for 5 s; a later one still counts), `granted` (of cancel, take and
/// release), `running`, and the ends of a goal: `succeeded`, `aborted`, `preempted`, `cancelled`.
class TaskDesk {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A line could not become a request.
  void refuse(const std::string& line, const std::string& reason);
  /// The request of `line` was sent under `number`.
  void sent(const std::string& line, const TaskLine& what, std::uint64_t number, Time now);
  /// Numbers of the requests that have no answer yet.
  [[nodiscard]] std::vector<std::uint64_t> waiting() const;
  /// `input` has answered.
  void answered(const msg::RequestAnswer& answer);
  /// To be called often: looks for goals that navigation refused or that ended, and for requests without an answer.
  void look(const GoalTracker& goals, Time now);

  /// True while a goal of a ROS program runs, or may begin to.
  [[nodiscard]] bool busy() const;
  /// True if the last granted request was `take`: authority is kept although no goal runs.
  [[nodiscard]] bool keeps_authority() const { return keeps_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }
  [[nodiscard]] const std::string& last_reason() const { return last_reason_; }
  /// The answers since the last call, oldest first.
  [[nodiscard]] std::vector<std::string> answers();

 private:
  struct Entry {
    std::string line;
    TaskLine::Kind kind = TaskLine::Kind::kStart;
    std::uint64_t number = 0;  ///< of the request; 0: it is answered
    std::uint64_t goal = 0;    ///< of a granted start
    bool runs = false;         ///< navigation has accepted the goal
    bool late = false;         ///< `unanswered` was written
    Time sent{};
  };
  void say(const Entry& entry, const std::string& state, const std::string& reason = {});

  std::deque<Entry> entries_;
  std::vector<std::string> answers_;
  bool keeps_ = false;
  std::uint32_t epoch_ = 0;  ///< of the newest look()
  std::uint64_t refused_ = 0;
  std::string last_reason_;
};

/// The state of the current goal as JSON, with the names of constants: task, state, phase, progress, carrying, reason.
[[nodiscard]] std::string task_status_json(const msg::TaskStatus& status);
/// An event as JSON: time_s, task, event, goal, goal_state, colour, object, detail.
[[nodiscard]] std::string task_event_json(const msg::TaskEvent& event);

}  // namespace constrictor::ros_bridge
