// The state of a run as its DDS topics show it: progress, health of the components, which member waits for which.
// Observing a run never delays it.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "client/newest_epoch.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// The newest known state of a run. Takes messages in any order. Messages of an earlier epoch (before a reset) or of
/// another run are ignored, except ComponentStatus, which is always used as the health of its component.
struct RunView {
  /// `run_id`: the run to observe; 0: the first one of which a message arrives.
  explicit RunView(std::uint64_t run_id) : meant_(run_id), present_(run_id) {}
  RunView() : RunView(0) {}

  std::int64_t tick = -1;  ///< newest tick of any component in this epoch; -1: the epoch has not begun
  double period_s = 0.02;  ///< [s] control period
  std::optional<msg::MissionStatus> mission;
  std::optional<msg::TaskStatus> task;
  std::optional<msg::Authority> authority;
  std::optional<msg::RunState> run_state;
  std::map<std::string, msg::ComponentStatus> components;
  std::map<std::string, msg::Hello> hellos;       ///< the newest one of each member, by component
  std::map<std::string, std::uint64_t> overruns;  ///< by component, summed over its incarnations
  std::map<std::string, std::uint64_t> refused;

  void take(const msg::Tick& message);
  void take(const msg::Hello& message);
  void take(const msg::ComponentStatus& message);
  void take(const msg::MissionStatus& message);
  void take(const msg::TaskStatus& message);
  void take(const msg::Authority& message);
  void take(const msg::RunState& message);

  /// True if a wait has ended: the tick that it delayed is done, or the wait belongs to another run.
  [[nodiscard]] bool over(const msg::Waiting& waiting) const;
  /// True if the component published that the run has ended.
  [[nodiscard]] bool ended(const std::string& component) const;
  /// True if a member of the present epoch published that the run has ended: only the final tick makes it say so. The
  /// plant's own status can come seconds later, because a report in its process draws its figure first.
  [[nodiscard]] bool run_is_over() const;
  /// True if all members have finished the newest tick: only the pace or a pause delays the next one.
  [[nodiscard]] bool held() const { return run_state && run_state->ready_for_tick; }
  [[nodiscard]] double sim_time_s() const { return tick < 0 ? 0.0 : static_cast<double>(tick) * period_s; }
  /// True once every object of the mission has been delivered or given up.
  [[nodiscard]] bool mission_done() const;
  /// The seed in force, which a reset changes; `begun_with` before the first RunState.
  [[nodiscard]] std::uint64_t seed(std::uint64_t begun_with) const { return run_state ? run_state->seed : begun_with; }

 private:
  /// True if a message belongs to the present epoch; a message of a newer epoch begins that epoch.
  bool present(std::uint64_t message_run_id, std::uint32_t message_epoch);
  std::uint64_t meant_;
  NewestEpoch present_;
  std::map<std::string, std::uint64_t> earlier_overruns_;  ///< of incarnations before the newest
  std::map<std::string, std::uint64_t> earlier_refused_;
};

class RunObserver {
 public:
  /// Joins a DDS domain to observe the run `run_id` there; 0: the first run of which a message arrives. Throws
  /// dds::Error.
  explicit RunObserver(std::uint32_t domain, std::uint64_t run_id = 0);
  ~RunObserver();
  /// Takes the messages that arrived. Returns one line for each wait that began since the last call and still lasts.
  std::vector<std::string> poll();
  [[nodiscard]] const RunView& view() const { return view_; }
  /// The DDS participant, for other readers and writers of this process: a process joins a domain once.
  [[nodiscard]] std::int32_t participant() const;

 private:
  struct Readers;
  std::unique_ptr<Readers> readers_;
  RunView view_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::vector<msg::Waiting> waits_;                         ///< not examined yet
  std::map<std::string, std::int64_t> reported_waits_;      ///< tick of the last report by waiter and peer
  std::chrono::steady_clock::time_point cause_reported_{};  ///< last report of a wait that is not for a tick
};

/// "search line | follow line (drive) | 1 of 2 objects delivered, red next | 45.2 s simulated, 6.3x real time".
std::string progress_line(const RunView& view, double real_time_factor);

}  // namespace constrictor::cli
