// The bounded wait of all tests: call a condition until it holds.
#pragma once

#include <chrono>
#include <thread>

namespace constrictor::testing {

/// Calls `condition` every `pause` until it returns true. Returns false if it does not within `bound` of wall time. The
/// default bound is far above what any condition needs, because a test machine can be overloaded.
template <class Condition>
[[nodiscard]] bool eventually(Condition&& condition, std::chrono::milliseconds bound = std::chrono::seconds(20),
                              std::chrono::milliseconds pause = std::chrono::milliseconds(5)) {
  const auto end = std::chrono::steady_clock::now() + bound;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(pause);
  }
  return true;
}

}  // namespace constrictor::testing
