#include "plant/pace_check.hpp"

#include <fmt/format.h>

#include "configuration/configuration.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kWindow_ticks = 50;
constexpr double kSlowestClock = 0.6;  // wall time by run time; a late run catches up by at most 0.2 s

}  // namespace

void PaceCheck::look(const Tick& tick, std::int64_t now_ns, const char* what) {
  const std::int64_t ticks = tick.index - tick_;
  if (began_ && ticks < kWindow_ticks) return;
  const double wall_s = static_cast<double>(now_ns - time_ns_) * 1e-9;
  const bool known = began_ && now_ns != 0 && time_ns_ != 0;
  if (known && wall_s < kSlowestClock * static_cast<double>(ticks) * tick.period_s())
    throw ConfigurationError(
        fmt::format("--pace: found a run with {} ticks in {:.2f} s, accepted --pace realtime: {} cannot be faster than "
                    "the clock",
                    ticks, wall_s, what));
  began_ = true;
  tick_ = tick.index;
  time_ns_ = now_ns;
}

}  // namespace constrictor
