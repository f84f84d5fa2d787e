// The health of the run's components as ROS 2 diagnostics. Pure: no DDS calls, no clock.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "constrictor/messages.hpp"
#include "ros_types.h"

namespace constrictor::ros_bridge {

using DiagnosticArray = diagnostic_msgs_msg_dds__DiagnosticArray_;

/// The counters of the bridge since its start.
struct BridgeCounts {
  std::uint64_t dropped = 0;     ///< messages of the run that ROS 2 cannot represent
  std::uint64_t refused = 0;     ///< requests of ROS programs that the bridge or the run refused
  std::uint64_t unanswered = 0;  ///< requests that wait for an answer now
  std::string last_reason;       ///< of the last drop or refusal; empty: none
};

/// Keeps the newest status of each component, and writes it in ROS 2's words.
class Health {
 public:
  /// A component that is more ticks behind the run than this is reported as stale. Members report every 50 ticks.
  static constexpr std::int64_t kStale_ticks = 150;

  /// `robot`: the name of the robot, which becomes `hardware_id`.
  explicit Health(std::string robot) : robot_(std::move(robot)) {}
  Health(const Health&) = delete;
  Health& operator=(const Health&) = delete;

  void take(const msg::Tick& tick);
  void take(const msg::RunState& state);
  /// Ignores a status that breaks the IDL, and one of an older incarnation than the newest one. Ignores the status of a
  /// further component if there are already as many components as a run can have.
  void take(const msg::ComponentStatus& status);

  /// One status for each component, one for the run and one for the bridge, stamped with the newest tick. Levels:
  /// error, if a component has ended while the run goes on; stale, see kStale_ticks; warning, if a component starts,
  /// waits, rejected messages or missed steps since the last report, or if the bridge dropped or refused something
  /// since then. The message points into memory of this object: write it before the next call.
  [[nodiscard]] DiagnosticArray report(const BridgeCounts& counts);

 private:
  using Status = diagnostic_msgs_msg_dds__DiagnosticStatus_;
  using KeyValue = diagnostic_msgs_msg_dds__KeyValue_;
  struct Component {
    msg::ComponentStatus newest{};
    std::uint64_t reported_refused = 0, reported_overruns = 0;
  };
  char* keep(std::string words);
  void add(std::uint8_t level, std::string name, std::string message,
           const std::vector<std::pair<const char*, std::string>>& values);
  void add_component(const std::string& name, Component& component);

  std::string robot_;
  std::optional<msg::RunState> run_;
  std::int64_t tick_ = 0, time_ns_ = 0;
  std::uint32_t epoch_ = 0;
  std::map<std::string, Component> components_;
  std::uint64_t reported_dropped_ = 0, reported_refused_ = 0;
  std::deque<std::string> texts_;
  std::deque<std::vector<KeyValue>> values_;
  std::vector<Status> statuses_;
};

}  // namespace constrictor::ros_bridge
