// The parameters of navigation that may change while it runs.
#pragma once

#include "navigation/navigation_config.hpp"
#include "runtime/parameters.hpp"

namespace constrictor {

/// Adds a row for each of them: names are the keys of navigation.yaml, bounds those that its loader accepts.
void add_parameters(NavigationConfig& config, Parameters& parameters);

}  // namespace constrictor
