#include "runtime/pacer.hpp"

#include <algorithm>

#include "constrictor/messages.hpp"

namespace constrictor {
namespace {
constexpr std::int64_t kIdleWait_ns = 100'000'000;
constexpr std::int64_t kMostSteps = 1'000'000;
constexpr std::int64_t kMaxLag_ns = 200'000'000;  // a run that is late catches up by at most this
}  // namespace

bool Pacer::may_tick(std::int64_t time_ns) {
  wait_ns_ = kIdleWait_ns;
  if (paused_ && steps_ == 0) return false;
  const double pace = this->pace();
  if (pace <= 0.0 || steps_ > 0) return true;
  const auto now = Clock::now();
  if (!started_) {
    started_ = true;
    start_ = now;
    start_time_ns_ = time_ns;
  }
  const auto due = start_ + std::chrono::nanoseconds(
                                static_cast<std::int64_t>(static_cast<double>(time_ns - start_time_ns_) / pace));
  if (now >= due) {
    const std::int64_t lag = std::chrono::nanoseconds(now - due).count();
    if (lag > kMaxLag_ns) start_ += std::chrono::nanoseconds(lag - kMaxLag_ns);
    return true;
  }
  wait_ns_ = std::clamp<std::int64_t>(std::chrono::nanoseconds(due - now).count(), 0, kIdleWait_ns);
  return false;
}

void Pacer::control(std::uint8_t command, double pace, std::int64_t steps) {
  switch (command) {
    case msg::kRunPause:
      paused_ = true;
      steps_ = 0;
      break;
    case msg::kRunResume:
      paused_ = false;
      steps_ = 0;
      started_ = false;
      break;
    case msg::kRunStep:
      paused_ = true;
      steps_ += std::clamp<std::int64_t>(steps, 1, kMostSteps);
      break;
    case msg::kRunPace:
      pace_ = pace;
      overruled_ = operator_;
      started_ = false;
      break;
    default:
      break;
  }
}

void Pacer::operator_holds(bool holds) {
  if (holds == operator_) return;
  operator_ = holds;
  overruled_ = false;
  started_ = false;
}

}  // namespace constrictor
