// Decides when the conductor may send the next tick: in lock-step, limited to a multiple of real time, or paused.
#pragma once

#include <chrono>
#include <cstdint>

namespace constrictor {

class Pacer {
 public:
  /// A pace is 0 (as fast as possible) or from kSlowest to kFastest times real time. Slower paces are rejected: tick
  /// deadlines would overflow the clock.
  static constexpr double kSlowest = 0.001;
  static constexpr double kFastest = 1000.0;
  [[nodiscard]] static constexpr bool accepts(double pace) {
    return pace == 0.0 || (pace >= kSlowest && pace <= kFastest);
  }

  /// `pace`: at most this many times real time; 0: no limit. `operator_pace`: the same while an operator has authority.
  /// accepts() must be true for both, and for every later pace.
  explicit Pacer(double pace, double operator_pace = 0.0) : pace_(pace), operator_pace_(operator_pace) {}

  /// Whether the tick at simulated time `time_ns` may be sent now.
  [[nodiscard]] bool may_tick(std::int64_t time_ns);
  /// To be called when a tick was sent.
  void ticked() {
    if (steps_ > 0) --steps_;
  }
  /// Obeys kRunPause, kRunResume, kRunStep (`steps` more ticks) or kRunPace. A pace that is set while an operator has
  /// authority replaces the operator's pace, until the operator loses authority.
  void control(std::uint8_t command, double pace, std::int64_t steps = 1);
  /// An operator has taken authority, or no longer has it.
  void operator_holds(bool holds);
  [[nodiscard]] bool paused() const { return paused_; }
  /// The pace in force, and whether it is the operator's pace.
  [[nodiscard]] double pace() const { return capped() ? operator_pace_ : pace_; }
  [[nodiscard]] bool capped() const {
    return operator_ && !overruled_ && operator_pace_ > 0.0 && (pace_ <= 0.0 || pace_ > operator_pace_);
  }
  /// The state that a successor of this process needs: pace, pause, steps left.
  template <class Archive>
  void serialize(Archive& archive) {
    archive(pace_, operator_, overruled_, paused_, steps_);
  }
  /// A new epoch begins: simulated time starts again.
  void restart() { started_ = false; }
  /// True while the run is paused and no step is left.
  [[nodiscard]] bool holding() const { return paused_ && steps_ == 0; }
  /// [ns] time until may_tick() can become true by time alone.
  [[nodiscard]] std::int64_t wait_ns() const { return wait_ns_; }

 private:
  using Clock = std::chrono::steady_clock;
  double pace_;
  double operator_pace_;
  bool operator_ = false;
  bool overruled_ = false;  ///< a pace was set since the operator took authority
  bool paused_ = false;
  std::int64_t steps_ = 0;
  bool started_ = false;
  Clock::time_point start_{};  ///< wall time of start_time_ns_
  std::int64_t start_time_ns_ = 0;
  std::int64_t wait_ns_ = 100'000'000;
};

}  // namespace constrictor
