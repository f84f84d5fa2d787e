// Puts the faults of a plan between a component and its inputs.
#pragma once

#include <functional>
#include <memory>

#include "component/component.hpp"
#include "faults/fault_plan.hpp"

namespace constrictor {

/// A factory of the same component whose inputs have the plan's faults of topics, and whose steps take longer where the
/// plan says so. Which samples are concerned depends only on the plan, the run's seed, and the number and time stamp of
/// the sample: every reader sees the same faults, in every distribution over processes and after every restart. If the
/// plan is empty, this is `factory` itself. `wait_ms` is called with the wall time [ms] that a step takes longer: the
/// components themselves know no clock.
[[nodiscard]] ComponentFactory with_faults(
    ComponentFactory factory, std::shared_ptr<const FaultPlan> plan,
    std::function<void(double)> wait_ms = [](double) {});

}  // namespace constrictor
