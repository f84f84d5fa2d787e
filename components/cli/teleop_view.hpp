// What `constrictor teleop` shows of a run: read from DDS as an observer.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

#include "cli/run_attachment.hpp"
#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// The newest of each; empty before the first.
struct TeleopView {
  std::optional<msg::RunState> run;
  std::optional<msg::TaskStatus> task;
  std::optional<msg::MissionStatus> mission;
  std::optional<msg::JointState> joints;
  std::optional<msg::ContactState> contacts;
  std::deque<std::string> events;  ///< the last few, oldest first
  double silent_s = 0.0;           ///< [s] since the newest of `run`, as RunAttachment says
};

class TeleopObserver {
 public:
  /// `participant`: of DDS, owned by somebody who lives longer. `plant`: its component.
  TeleopObserver(std::int32_t participant, std::string plant);
  ~TeleopObserver();
  void poll();
  /// Of the run that was heard of first, and nothing of any other.
  [[nodiscard]] const TeleopView& view() const { return view_; }
  /// What there is to be seen of the run, its launcher aside.
  [[nodiscard]] RunSigns signs() const;

 private:
  struct Readers;
  std::unique_ptr<Readers> readers_;
  std::string plant_;
  TeleopView view_;
  RunSigns signs_;
  std::optional<std::uint64_t> run_id_;  ///< of the first run that was heard of
};

}  // namespace constrictor::cli
