#include "video/frame_clock.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor::video {

FrameClock::FrameClock(std::int64_t period_ns) : period_ns_(period_ns) { intervals_.fill(period_ns); }

void FrameClock::learn(std::int64_t interval_ns) {
  intervals_[learned_++ % kIntervals] = interval_ns;
  auto sorted = intervals_;
  std::nth_element(sorted.begin(), sorted.begin() + kIntervals / 2, sorted.end());
  period_ns_ = sorted[kIntervals / 2];
}

FrameClock::Verdict FrameClock::on_frame(std::int64_t began_ns, std::int64_t ended_ns) {
  const bool first = last_ended_ns_ < 0;
  const std::int64_t interval_ns = first ? 0 : ended_ns - last_ended_ns_;
  const auto silence_ns = static_cast<std::int64_t>(kSilence_periods * static_cast<double>(period_ns_));
  const bool waited = ended_ns - began_ns >= period_ns_ / 2;
  if (first || interval_ns > silence_ns) {
    catching_up_since_ns_ = ended_ns;
  } else if (catching_up_since_ns_ >= 0) {
    if (waited || ended_ns - catching_up_since_ns_ > kMostCatchingUp_ns) catching_up_since_ns_ = -1;
  }
  Verdict verdict;
  verdict.fresh = catching_up_since_ns_ < 0;
  // A frame that was there already was sent one period after the one before it.
  verdict.sent_ns = waited || first ? ended_ns : std::min(ended_ns, last_sent_ns_ + period_ns_);
  if (!first && interval_ns > period_ns_ * 3 / 2)
    verdict.missing = std::llround(static_cast<double>(interval_ns) / static_cast<double>(period_ns_)) - 1;
  // A frame for which the reader waited shows the true rate, also if the promised one is wrong by far.
  if (!first && (waited || verdict.fresh)) learn(interval_ns);
  last_ended_ns_ = ended_ns;
  last_sent_ns_ = verdict.sent_ns;
  return verdict;
}

FrameClock::Verdict FrameClock::on_stamped_frame(std::int64_t stamp_ns) {
  Verdict verdict{true, stamp_ns, 0};
  if (last_sent_ns_ >= 0) {
    const std::int64_t interval_ns = stamp_ns - last_sent_ns_;
    if (interval_ns > period_ns_ * 3 / 2)
      verdict.missing = std::llround(static_cast<double>(interval_ns) / static_cast<double>(period_ns_)) - 1;
    learn(interval_ns);
  }
  last_sent_ns_ = last_ended_ns_ = stamp_ns;
  return verdict;
}

}  // namespace constrictor::video
