// Step times and CPU time of a member, for ComponentStatus. Components do not see them.
#pragma once

#include <chrono>
#include <cstdint>
#include <vector>

#include "constrictor/messages.hpp"

namespace constrictor {

class StatusMeter {
 public:
  void add(std::chrono::nanoseconds step) {
    steps_us_.push_back(std::chrono::duration<double, std::micro>(step).count());
  }
  /// True when the next ComponentStatus is due after the step of `tick`. A tick before that of the last status belongs
  /// to a new epoch.
  [[nodiscard]] bool due(std::int64_t tick) const { return tick >= next_tick_ || tick < next_tick_ - kInterval_ticks; }
  /// Fills the measured fields of `status` and begins a new interval.
  void fill(msg::ComponentStatus& status);

 private:
  static constexpr std::int64_t kInterval_ticks = 50;
  std::vector<double> steps_us_;
  std::int64_t next_tick_ = 0;
};

}  // namespace constrictor
