// How clients wait for messages of a run.
#pragma once

#include <chrono>

namespace constrictor {

/// Bounds of waits count in this clock, because messages come from processes that may stop.
using WaitClock = std::chrono::steady_clock;

/// A client that waits for a message looks again after this time.
inline constexpr std::chrono::milliseconds kPoll{10};

}  // namespace constrictor
