// What a run tells observers over DDS: how far it is, who is healthy, who waits for whom. Never holds the run up.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// The newest known state of a run.
struct RunView {
  std::int64_t tick = -1;                         ///< newest of any component; -1: the run did not begin
  double period_s = 0.02;                         ///< [s] control period
  std::optional<msg::MissionStatus> mission;
  std::optional<msg::TaskStatus> task;
  std::optional<msg::Authority> authority;
  std::optional<msg::RunState> run_state;
  std::map<std::string, msg::ComponentStatus> components;
  std::map<std::string, std::uint64_t> overruns;  ///< by component, all of its incarnations
  std::map<std::string, std::uint64_t> refused;

  /// True if the component said that the run is over for it.
  [[nodiscard]] bool ended(const std::string& component) const;
  [[nodiscard]] double sim_time_s() const { return tick < 0 ? 0.0 : static_cast<double>(tick) * period_s; }
};

class RunObserver {
 public:
  /// Joins a DDS domain. Throws dds::Error.
  explicit RunObserver(std::uint32_t domain);
  ~RunObserver();
  /// Takes in what arrived. Returns who newly waits for something, as text for people.
  std::vector<std::string> poll();
  [[nodiscard]] const RunView& view() const { return view_; }

 private:
  struct Readers;
  std::unique_ptr<Readers> readers_;
  RunView view_;
  std::map<std::string, std::uint64_t> earlier_overruns_;  ///< of incarnations before the newest
  std::map<std::string, std::uint64_t> earlier_refused_;
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
