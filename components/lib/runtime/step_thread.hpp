// A thread in which one member steps, so that its process can go on meanwhile.
#pragma once

#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <semaphore>
#include <thread>

namespace constrictor {

/// Runs one function at a time. All functions of this class belong to the thread that constructed it.
class StepThread {
 public:
  /// `notify` is called in the new thread after each function, when finished() has become true. It must not throw.
  explicit StepThread(std::function<void()> notify);
  StepThread(const StepThread&) = delete;
  StepThread& operator=(const StepThread&) = delete;
  /// Waits for the function in progress; one that has not begun may be dropped.
  ~StepThread();

  /// Starts `step`. The previous function must have been collected.
  void start(std::function<void()> step);
  /// Whether a function was started and has returned or thrown.
  [[nodiscard]] bool finished() const { return finished_.load(std::memory_order_acquire); }
  /// Waits until finished().
  void wait() const { finished_.wait(false, std::memory_order_acquire); }
  /// Waits for the started function, and returns its duration. Rethrows what it has thrown.
  std::chrono::nanoseconds collect();

 private:
  void run();

  std::function<void()> notify_;
  std::function<void()> step_;
  std::exception_ptr error_;
  std::chrono::nanoseconds duration_{};
  std::counting_semaphore<2> started_{0};  // a function, and the end
  std::atomic<bool> finished_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;  // the last member: it uses the others
};

}  // namespace constrictor
