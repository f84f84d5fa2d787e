#include "runtime/jitter_meter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "configuration/quantiles.hpp"

namespace constrictor {

void JitterMeter::arrived(Clock::time_point now, std::int64_t time_ns) {
  if (last_) {
    const auto late = now - last_->at - std::chrono::nanoseconds(time_ns - last_->time_ns);
    const double late_us = std::chrono::duration<double, std::micro>(late).count();
    interval_us_.push_back(late_us);
    max_us_ = std::max(max_us_, late_us);
    const auto place = std::lower_bound(kClasses_us.begin(), kClasses_us.end(), late_us) - kClasses_us.begin();
    ++counts_[static_cast<std::size_t>(place)];
  }
  last_ = Arrival{now, time_ns};
}

void JitterMeter::begin() { *this = {}; }

void JitterMeter::fill(msg::ComponentStatus& status) {
  status.jitter_p50_us = lower_quantile(interval_us_, 0.5);
  status.jitter_p99_us = lower_quantile(interval_us_, 0.99);
  status.jitter_max_us = std::isfinite(max_us_) ? max_us_ : std::numeric_limits<double>::quiet_NaN();
  interval_us_.clear();
}

std::string JitterMeter::histogram() const {
  const auto total = std::accumulate(counts_.begin(), counts_.end(), std::uint64_t{0});
  if (total == 0) return {};
  std::string text = fmt::format("{} ticks:", total);
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kClasses_us.size(); ++i) {
    if (counts_[i] == 0) continue;
    sum += counts_[i];
    text += fmt::format(" {:.1f} % at most {:g} ms late,",
                        100.0 * static_cast<double>(sum) / static_cast<double>(total), 1e-3 * kClasses_us.at(i));
  }
  return text + fmt::format(" the latest {:.1f} ms", 1e-3 * max_us_);
}

}  // namespace constrictor
