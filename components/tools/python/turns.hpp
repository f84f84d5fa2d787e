// Lets the threads of a Python program share one client of a run.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace constrictor::python {

/// A lock that threads get in the order in which they asked for it. A thread that waits long for a message gives the
/// others a turn with pass(), so that an emergency stop of another thread is sent at once; std::mutex does not promise
/// that.
class Turns {
 public:
  void lock() {
    std::unique_lock lock(mutex_);
    const std::uint64_t mine = next_++;
    changed_.wait(lock, [&] { return mine == serving_; });
  }
  void unlock() {
    {
      const std::lock_guard lock(mutex_);
      ++serving_;
    }
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::uint64_t next_ = 0;
  std::uint64_t serving_ = 0;
};

}  // namespace constrictor::python
