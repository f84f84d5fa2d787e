// The time between the ticks of all checks.
#pragma once

namespace constrictor::conform {

inline constexpr double kTick_s = 0.02;

}  // namespace constrictor::conform
