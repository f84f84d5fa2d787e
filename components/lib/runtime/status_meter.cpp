#include "runtime/status_meter.hpp"

#include <sys/resource.h>

#include "configuration/quantiles.hpp"

namespace constrictor {
namespace {

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
  status.step_time_p50_us = lower_quantile(steps_us_, 0.5);
  status.step_time_p99_us = lower_quantile(steps_us_, 0.99);
  status.cpu_s = cpu_seconds();
  next_tick_ = status.tick + kInterval_ticks;
  steps_us_.clear();
}

}  // namespace constrictor
