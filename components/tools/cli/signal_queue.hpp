// Signals that the launcher waits for instead of being interrupted by them.
#pragma once

#include <chrono>
#include <csignal>

namespace constrictor::cli {

/// Blocks SIGINT, SIGTERM, SIGHUP and SIGCHLD in this thread, and in threads that it starts later, until destruction.
class SignalQueue {
 public:
  SignalQueue();
  ~SignalQueue();
  SignalQueue(const SignalQueue&) = delete;
  SignalQueue& operator=(const SignalQueue&) = delete;

  /// Waits up to `bound` for a signal. Returns SIGINT, SIGTERM or SIGHUP if one of them arrived; 0 after the bound or
  /// when only children ended.
  int wait(std::chrono::milliseconds bound) const;

 private:
  sigset_t set_{};
  sigset_t before_{};
  int descriptor_ = -1;
};

}  // namespace constrictor::cli
