// The time in which a process runs.
#pragma once

#include <algorithm>
#include <chrono>

namespace constrictor {

/// A clock that almost stands still while the process is stopped, so that a wait for others does not end too early.
/// Read it several times a second: a gap of more than 1 s between two readings means that this process did not run
/// (SIGSTOP, a stopped virtual machine), and perhaps the others did not run either. Such a gap counts as 1 s.
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
