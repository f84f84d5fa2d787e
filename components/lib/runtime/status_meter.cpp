#include "runtime/status_meter.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <limits>

namespace constrictor {
namespace {

double quantile(std::vector<double>& values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

double cpu_seconds() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}  // namespace

void StatusMeter::fill(msg::ComponentStatus& status) {
  status.step_time_p50_us = quantile(steps_us_, 0.5);
  status.step_time_p99_us = quantile(steps_us_, 0.99);
  status.cpu_s = cpu_seconds();
  status.jitter_p50_us = status.jitter_p99_us = status.jitter_max_us = std::numeric_limits<double>::quiet_NaN();
  next_tick_ = status.tick + kInterval_ticks;
  steps_us_.clear();
}

}  // namespace constrictor
