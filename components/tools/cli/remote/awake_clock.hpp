// The time in which a process runs.
#pragma once

#include <algorithm>
#include <chrono>

namespace constrictor::cli {

/// A clock that must be read often. A long gap between two readings, in which the process or its computer was stopped,
/// counts as 1 s, as in the processes of a run: a freeze of all hosts is not taken for a host that is away.
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

}  // namespace constrictor::cli
