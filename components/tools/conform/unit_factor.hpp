// How wrong units are told from wrong gains.
#pragma once

namespace constrictor::conform {

/// Angles that are larger than expected by more than this factor, or smaller, have a wrong unit.
inline constexpr double kUnitFactor = 8.0;

}  // namespace constrictor::conform
