#include "runtime/step_thread.hpp"

#include <utility>

namespace constrictor {

StepThread::StepThread(std::function<void()> notify) : notify_(std::move(notify)), thread_([this] { run(); }) {}

StepThread::~StepThread() {
  stop_ = true;
  started_.release();
  thread_.join();
}

void StepThread::start(std::function<void()> step) {
  step_ = std::move(step);
  started_.release();
}

std::chrono::nanoseconds StepThread::collect() {
  wait();
  finished_ = false;
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return duration_;
}

void StepThread::run() {
  for (;;) {
    started_.acquire();
    if (stop_) return;
    const auto start = std::chrono::steady_clock::now();
    try {
      step_();
    } catch (...) {
      error_ = std::current_exception();
    }
    duration_ = std::chrono::steady_clock::now() - start;
    finished_.store(true, std::memory_order_release);
    finished_.notify_one();
    notify_();
  }
}

}  // namespace constrictor
