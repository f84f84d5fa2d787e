// How clients wait for messages of a run.
#pragma once

#include <chrono>
#include <thread>

namespace constrictor {

/// Bounds of waits count in this clock, because messages come from processes that may stop.
using WaitClock = std::chrono::steady_clock;

/// A client that waits for a message looks again after this time.
inline constexpr std::chrono::milliseconds kPoll{10};

/// When a writer discovers a reader, it sends the messages that it keeps for late readers. The time between two of them
/// is shorter than this: if nothing has arrived for so long, all have arrived.
inline constexpr std::chrono::milliseconds kQuiet{300};

/// Waits until nothing new has arrived for the time `quiet` and `enough()` holds, at most until `bound` has passed.
/// `poll()` takes what has arrived and returns whether something of it is new; it is called once at least.
template <class Poll, class Enough>
void wait_until_quiet(std::chrono::milliseconds quiet, std::chrono::milliseconds bound, Poll&& poll, Enough&& enough) {
  const auto end = WaitClock::now() + bound;
  for (auto changed = WaitClock::now();; std::this_thread::sleep_for(kPoll)) {
    if (poll()) changed = WaitClock::now();
    const auto now = WaitClock::now();
    if (now >= end || (now - changed > quiet && enough())) return;
  }
}

}  // namespace constrictor
