// The parameters of perception that may change while it runs.
#pragma once

#include "perception/perception_config.hpp"
#include "runtime/parameters.hpp"

namespace constrictor::perception {

/// Adds a row for each of them: names are the keys of perception.yaml, bounds those that its loader accepts.
void add_parameters(PerceptionConfig& config, Parameters& parameters);

}  // namespace constrictor::perception
