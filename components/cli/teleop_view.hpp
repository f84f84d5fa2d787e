// What `constrictor teleop` shows of a run: read from DDS as an observer.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>

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
};

class TeleopObserver {
 public:
  /// `participant`: of DDS, owned by somebody who lives longer.
  explicit TeleopObserver(std::int32_t participant);
  ~TeleopObserver();
  void poll();
  [[nodiscard]] const TeleopView& view() const { return view_; }

 private:
  struct Readers;
  std::unique_ptr<Readers> readers_;
  TeleopView view_;
};

}  // namespace constrictor::cli
