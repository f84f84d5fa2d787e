// The state of a run that `constrictor teleop` shows, read over DDS as an observer.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "client/run_monitor.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// The newest message of each topic; empty before the first.
struct TeleopView {
  std::optional<msg::RunState> run;
  std::optional<msg::TaskStatus> task;
  std::optional<msg::MissionStatus> mission;
  std::optional<msg::JointState> joints;
  std::optional<msg::ContactState> contacts;
  std::deque<std::string> events;  ///< the last ones, oldest first
  double silent_s = 0.0;           ///< [s] since the newest `run` (RunAttachment::silent_s)
};

/// Reads the topics of a TeleopView; ignores messages of any run but the one that `monitor` watches.
class TeleopObserver {
 public:
  /// `participant` and `monitor` must outlive this object.
  TeleopObserver(std::int32_t participant, const RunMonitor& monitor);
  ~TeleopObserver();
  /// Takes everything that has arrived. To be called after `monitor.poll()`.
  void poll();
  [[nodiscard]] const TeleopView& view() const { return view_; }

 private:
  struct Readers;
  std::unique_ptr<Readers> readers_;
  const RunMonitor& monitor_;
  TeleopView view_;
};

}  // namespace constrictor::cli
