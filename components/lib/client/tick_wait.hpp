// The bound on a wait for ticks of a run.
#pragma once

#include <chrono>
#include <cstdint>

namespace constrictor {

/// A wait that ends when the run has made no tick for `bound`; it lasts as long as the run makes ticks. Pure: time is
/// an argument.
class TickWait {
 public:
  using Time = std::chrono::steady_clock::time_point;
  TickWait(std::chrono::seconds bound, Time now) : bound_(bound), end_(now + bound) {}
  /// A RunState arrived with `tick` as the run's next tick.
  void heard(std::int64_t tick, Time now) {
    if (tick != next_tick_) end_ = now + bound_;
    next_tick_ = tick;
  }
  [[nodiscard]] bool over(Time now) const { return now > end_; }
  [[nodiscard]] std::int64_t next_tick() const { return next_tick_; }  ///< -1: no RunState arrived

 private:
  std::chrono::seconds bound_;
  Time end_;
  std::int64_t next_tick_ = -1;
};

}  // namespace constrictor
