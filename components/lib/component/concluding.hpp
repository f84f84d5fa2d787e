// An interface for components that do something when the run ends.
#pragma once

#include "component/component.hpp"

namespace constrictor {

class Concluding {
 public:
  virtual ~Concluding() = default;
  /// Called once, at the final tick of the run and after the component's last step, whether a component, `run_control`
  /// or the limit of simulated time ended the run. `last`: the tick of the last step. The input ports still hold what
  /// they held in that step, also in a process that was restarted after it, except that no sample is fresh there;
  /// outputs are no longer sent.
  virtual void conclude(const Tick& last) = 0;
};

}  // namespace constrictor
