// The refused requests of the planner, and the pauses before it makes requests again.
#pragma once

#include <cereal/types/string.hpp>
#include <cereal/types/vector.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "planner/planner_config.hpp"

namespace constrictor {

/// The refusals of one task since it was last accepted.
struct RefusedTask {
  std::uint8_t task = 0;
  int count = 0;
  double since_s = 0.0;  ///< active time of the first one
  double until_s = 0.0;  ///< active time before which the task is not requested again
  template <class Archive>
  void serialize(Archive& archive) {
    archive(task, count, since_s, until_s);
  }
};

struct RefusalMemory {
  int in_a_row = 0;            ///< refusals since a request of any task was accepted
  double since_s = 0.0;        ///< active time of the first of them
  double next_s = 0.0;         ///< active time before which nothing is requested
  std::uint8_t task = 0;       ///< of the last refused request: kTask...
  std::uint8_t direction = 0;  ///< of that request: kDirection...
  bool again = false;          ///< the same request is to be made again
  std::string reason;          ///< of the last refusal
  std::vector<RefusedTask> tasks;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(in_a_row, since_s, next_s, task, direction, again, reason, tasks);
  }
};

/// Decides when a request may follow after refusals. All times are active times of the mission [s]. The pauses double
/// with each refusal, from `refused_pause_s` to `refused_longest_pause_s`.
class Refusals {
 public:
  Refusals(const PlannerConfig& config, RefusalMemory& memory) : config_(config), memory_(memory) {}

  /// A request of this task was accepted.
  void accept(std::uint8_t task);
  /// The refusal is temporary: the same request is made again after a pause.
  void wait(std::uint8_t task, const std::string& reason, double now_s);
  /// The cause is the request itself, so that a repetition would be refused, too. Another request may follow at once,
  /// unless another one was refused just before. The same task must wait.
  void reject(std::uint8_t task, std::uint8_t direction, const std::string& reason, double now_s);
  void forget() { memory_ = {}; }

  [[nodiscard]] bool any() const { return memory_.in_a_row > 0; }
  /// Whether the last request was refused, and would be refused again.
  [[nodiscard]] bool rejected() const { return any() && !memory_.again; }
  /// Whether any request has to wait.
  [[nodiscard]] bool pausing(double now_s) const { return any() && now_s < memory_.next_s; }
  /// Whether this task was refused a short time ago.
  [[nodiscard]] bool barred(std::uint8_t task, double now_s) const;
  /// Why the mission must end: nothing, or not this task again and again, was accepted for `refused_timeout_s`. Empty:
  /// it goes on.
  [[nodiscard]] std::string give_up(double now_s) const;
  /// The reaction of the mission to the last refusal, as a predicate for people. Empty after an acceptance.
  [[nodiscard]] std::string answer() const;

 private:
  void count(std::uint8_t task, const std::string& reason, double now_s);
  /// [s] the pause after this number of refusals.
  [[nodiscard]] double pause_s(int refusals) const;

  const PlannerConfig& config_;
  RefusalMemory& memory_;
};

}  // namespace constrictor
