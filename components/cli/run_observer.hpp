// What a run tells observers over DDS: how far it is, who is healthy, who waits for whom. Never holds the run up.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/newest_epoch.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// The newest known state of a run. Takes messages in any order; what is of an epoch before the newest (a run that was reset) or
/// of another run counts only as health of the component that says it.
struct RunView {
  /// `run_id`: the run that is meant, of which alone anything counts; 0: the first that is heard of.
  explicit RunView(std::uint64_t run_id) : meant_(run_id), present_(run_id) {}
  RunView() : RunView(0) {}

  std::int64_t tick = -1;                         ///< newest of any component in this epoch; -1: it did not begin
  double period_s = 0.02;                         ///< [s] control period
  std::optional<msg::MissionStatus> mission;
  std::optional<msg::TaskStatus> task;
  std::optional<msg::Authority> authority;
  std::optional<msg::RunState> run_state;
  std::map<std::string, msg::ComponentStatus> components;
  std::map<std::string, std::uint64_t> overruns;  ///< by component, all of its incarnations
  std::map<std::string, std::uint64_t> refused;

  void take(const msg::Tick& message);
  void take(const msg::ComponentStatus& message);
  void take(const msg::MissionStatus& message);
  void take(const msg::TaskStatus& message);
  void take(const msg::Authority& message);
  void take(const msg::RunState& message);

  /// True if a wait has ended: the tick that it was for is done, or it was of another run.
  [[nodiscard]] bool over(const msg::Waiting& waiting) const;
  /// True if the component said that the run is over for it.
  [[nodiscard]] bool ended(const std::string& component) const;
  /// True if nobody keeps the next tick waiting, only the pace or a pause.
  [[nodiscard]] bool held() const { return run_state && run_state->held; }
  [[nodiscard]] double sim_time_s() const { return tick < 0 ? 0.0 : static_cast<double>(tick) * period_s; }
  /// The seed in force, which a reset changes; `begun_with` before the run's first word.
  [[nodiscard]] std::uint64_t seed(std::uint64_t begun_with) const { return run_state ? run_state->seed : begun_with; }

 private:
  /// True if it is of the present epoch; a newer one begins with it.
  bool present(std::uint64_t message_run_id, std::uint32_t message_epoch);
  std::uint64_t meant_;
  NewestEpoch present_;
  std::map<std::string, std::uint64_t> earlier_overruns_;  ///< of incarnations before the newest
  std::map<std::string, std::uint64_t> earlier_refused_;
};

class RunObserver {
 public:
  /// Joins a DDS domain to watch a run there, or the first that it hears of (0). Throws dds::Error.
  explicit RunObserver(std::uint32_t domain, std::uint64_t run_id = 0);
  ~RunObserver();
  /// Takes in what arrived. Returns who newly waits for something, as text for people: nothing that is over already.
  std::vector<std::string> poll();
  [[nodiscard]] const RunView& view() const { return view_; }

 private:
  struct Readers;
  std::unique_ptr<Readers> readers_;
  RunView view_;
  std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now();
  std::vector<msg::Waiting> heard_waiting_;                ///< until it is known whether it is over
  std::map<std::string, std::int64_t> told_waiting_;       ///< component to the tick that was told
  std::chrono::steady_clock::time_point told_cause_{};     ///< when a wait for anything but a tick was last told
};

/// "follow_line | mission carry | green, 1 of 2 done | 45.2 s simulated at 6.3x real time".
std::string progress_line(const RunView& view, double real_time_factor);

/// Names for people: of kTask..., of kColour..., of kComponent... states.
const char* task_name(std::uint8_t task);
const char* colour_name(std::uint8_t colour);
const char* component_state_name(std::uint8_t state);

}  // namespace constrictor::cli
