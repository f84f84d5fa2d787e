// When the plant's host may send the next tick: lock-step, capped at a multiple of real time, paused, or step by step.
#pragma once

#include <chrono>
#include <cstdint>

namespace constrictor {

class Pacer {
 public:
  /// Paces are 0, as fast as it goes, or from kSlowest to kFastest times real time. Slower ones are nobody's wish, and the instants at
  /// which ticks are due would leave the clock's range.
  static constexpr double kSlowest = 0.001;
  static constexpr double kFastest = 1000.0;
  [[nodiscard]] static constexpr bool accepts(double pace) { return pace == 0.0 || (pace >= kSlowest && pace <= kFastest); }

  /// `pace`: at most so many times real time; 0: as fast as it goes. `operator_pace`: the same while an operator has authority. Both
  /// as accepts() says, and so is every pace later.
  explicit Pacer(double pace, double operator_pace = 0.0) : pace_(pace), operator_pace_(operator_pace) {}

  /// Whether a tick whose simulated time is `time_ns` may be sent now.
  [[nodiscard]] bool may_tick(std::int64_t time_ns);
  void ticked() {
    if (steps_ > 0) --steps_;
  }
  /// Applies kRunPause, kRunResume, kRunStep (`steps` more ticks) or kRunPace. A pace set while an operator has authority holds
  /// for that operator too.
  void control(std::uint8_t command, double pace, std::int64_t steps = 1);
  /// An operator has taken authority, or has it no longer.
  void operator_holds(bool holds);
  [[nodiscard]] bool paused() const { return paused_; }
  /// The pace in force, and whether it is the operator's cap.
  [[nodiscard]] double pace() const { return capped() ? operator_pace_ : pace_; }
  [[nodiscard]] bool capped() const {
    return operator_ && !overruled_ && operator_pace_ > 0.0 && (pace_ <= 0.0 || pace_ > operator_pace_);
  }
  /// A new epoch: time begins again.
  void restart() { started_ = false; }
  /// True while the pace, not a peer, keeps the next tick back.
  [[nodiscard]] bool holding() const { return paused_ && steps_ == 0; }
  /// [ns] how long nothing can become due.
  [[nodiscard]] std::int64_t wait_ns() const { return wait_ns_; }

 private:
  using Clock = std::chrono::steady_clock;
  double pace_;
  double operator_pace_;
  bool operator_ = false;
  bool overruled_ = false;          ///< a pace was set since the operator came
  bool paused_ = false;
  std::int64_t steps_ = 0;
  bool started_ = false;
  Clock::time_point start_{};       ///< wall time of start_time_ns_
  std::int64_t start_time_ns_ = 0;
  std::int64_t wait_ns_ = 100'000'000;
};

}  // namespace constrictor
