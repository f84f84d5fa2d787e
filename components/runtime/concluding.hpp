// What a component is beside `Component` if it has something to conclude when the run ends.
#pragma once

#include "runtime/component.hpp"

namespace constrictor {

class Concluding {
 public:
  Concluding() = default;
  Concluding(const Concluding&) = delete;
  Concluding& operator=(const Concluding&) = delete;
  virtual ~Concluding() = default;
  /// Called once, at the run's final tick and after the component's last step, whoever ended the run: a component, `run_control`, or
  /// the plant's limit of time. `last` is the tick of that step. The ports still have what they had then; nothing can be sent any more.
  virtual void conclude(const Tick& last) = 0;
};

}  // namespace constrictor
