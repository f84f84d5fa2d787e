// The time in which a process runs.
#pragma once

#include <algorithm>
#include <chrono>

namespace constrictor {

/// A clock that must be read several times a second. If it was not read for longer, the process did not run (SIGSTOP, a
/// stopped virtual machine), and neither did perhaps those for which it waits: such a gap counts as 1 s at most.
class AwakeClock {
 public:
  using Base = std::chrono::steady_clock;
  Base::time_point now() { return now(Base::now()); }
  /// `reading` is that of the steady clock.
  Base::time_point now(Base::time_point reading) {
    time_ += std::min<Base::duration>(reading - last_reading_, kLongestGap);
    last_reading_ = reading;
    return time_;
  }

 private:
  static constexpr std::chrono::seconds kLongestGap{1};
  Base::time_point last_reading_ = Base::now(), time_ = last_reading_;
};

}  // namespace constrictor
