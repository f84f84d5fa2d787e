// When the plant's host may send the next tick: lock-step, capped at a multiple of real time, paused, or step by step.
#pragma once

#include <chrono>
#include <cstdint>

namespace constrictor {

class Pacer {
 public:
  /// `pace`: at most so many times real time; 0: as fast as it goes.
  explicit Pacer(double pace) : pace_(pace) {}

  /// Whether a tick whose simulated time is `time_ns` may be sent now.
  [[nodiscard]] bool may_tick(std::int64_t time_ns);
  void ticked() {
    if (steps_ > 0) --steps_;
  }
  /// Applies kRunPause, kRunResume, kRunStep or kRunPace.
  void control(std::uint8_t command, double pace);
  /// A new epoch: time begins again.
  void restart() { started_ = false; }
  /// True while the pace, not a peer, keeps the next tick back.
  [[nodiscard]] bool holding() const { return paused_ && steps_ == 0; }
  /// [ns] how long nothing can become due.
  [[nodiscard]] std::int64_t wait_ns() const { return wait_ns_; }

 private:
  using Clock = std::chrono::steady_clock;
  double pace_;
  bool paused_ = false;
  std::int64_t steps_ = 0;
  bool started_ = false;
  Clock::time_point start_{};       ///< wall time of start_time_ns_
  std::int64_t start_time_ns_ = 0;
  std::int64_t wait_ns_ = 100'000'000;
};

}  // namespace constrictor
