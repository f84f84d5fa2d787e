// When the planner of a run gives up a search for the line, or a look at a dropped object.
#pragma once

#include "cli/evaluate/recoveries.hpp"
#include "cli/launch_plan.hpp"

namespace constrictor::cli {

/// The limits that the planner's configuration and the scenario's mission state; infinite if the run has no planner, or
/// one with another configuration.
[[nodiscard]] SearchLimits search_limits_of(const RunOptions& options);

}  // namespace constrictor::cli
