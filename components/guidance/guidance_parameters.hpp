// The parameters of guidance that may change while it runs.
#pragma once

#include "guidance/guidance_config.hpp"
#include "runtime/parameters.hpp"

namespace constrictor::guidance {

/// Adds a row for each of them: names are the keys of guidance.yaml, bounds those that its loader accepts.
void add_parameters(GuidanceConfig& config, Parameters& parameters);

}  // namespace constrictor::guidance
