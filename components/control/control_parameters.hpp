// The parameters of control that may change while it runs.
#pragma once

#include "control/control_config.hpp"
#include "runtime/parameters.hpp"

namespace constrictor {

/// Adds a row for each of them: names are the keys of control.yaml, bounds those that its loader accepts.
void add_parameters(ControlConfig& config, Parameters& parameters);

}  // namespace constrictor
