// Ends a run that is faster than the clock, for plants whose hardware cannot be.
#pragma once

#include <cstdint>

#include "component/component.hpp"

namespace constrictor {

class PaceCheck {
 public:
  /// To be called at every tick. `now_ns`: a clock that rises; 0: it is not known. `what`: "real servos". Throws
  /// ConfigurationError when 50 ticks took much less time than they stand for; a late run may catch up by 0.2 s.
  void look(const Tick& tick, std::int64_t now_ns, const char* what);

 private:
  bool began_ = false;
  std::int64_t tick_ = 0;     ///< at which the measurement began
  std::int64_t time_ns_ = 0;  ///< clock at that tick
};

}  // namespace constrictor
