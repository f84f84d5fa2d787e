// The parameters that every plant has.
#pragma once

#include "configuration/parameter_set.hpp"
#include "robot/safety_gate.hpp"

namespace constrictor {

struct PlantParameters : ParameterSet {
 protected:
  /// Adds the rows `command.*` of the safety gate.
  GateLimits add_gate_limits(GateLimits& command) {
    return {add(command.stale_after_ticks, "command.stale_after_ticks", GateLimits{}.stale_after_ticks, "ticks",
                {1, 100000}, kAtStart, "A command older than this is not obeyed: the joints hold the measured posture"),
            add(command.relax_after_ticks, "command.relax_after_ticks", GateLimits{}.relax_after_ticks, "ticks",
                {1, 1000000}, kAtStart, "After this time without an acceptable command the joints relax")};
  }
};

}  // namespace constrictor
