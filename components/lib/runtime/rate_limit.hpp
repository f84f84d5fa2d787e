// A limit on how often something is done, for answers to processes that may be hostile.
#pragma once

#include <chrono>

namespace constrictor {

/// At most `most` in each second, counted from the first.
class RateLimit {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr int kMost = 8;

  explicit RateLimit(int most = kMost) : most_(most) {}
  [[nodiscard]] bool allows(Clock::time_point now) {
    if (now - since_ > std::chrono::seconds(1)) {
      since_ = now;
      count_ = 0;
    }
    return ++count_ <= most_;
  }
  /// Whether the last one was the first of its second.
  [[nodiscard]] bool first() const { return count_ == 1; }

 private:
  int most_;
  Clock::time_point since_{};
  int count_ = 0;
};

}  // namespace constrictor
