// Writes a concrete scene as a scenario file.
#pragma once

#include <string>

#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

/// The text of a scenario file with this scene and without variation: read_scenario() returns the same scene for it,
/// with any seed. All places are in the frame `world`. Numbers are written in as few digits as give the same number
/// again; only the direction of the light and that of the slope are computed again when the file is read, so that their
/// last bit may differ. `mission`: the section of this name as YAML on one line; empty: the file has none. `comment`:
/// what the file begins with, one or more lines. Throws ConfigurationError if a scenario file cannot have this scene,
/// because a wide variation has drawn a value that a file must not name.
[[nodiscard]] std::string scenario_text(const Scenario& scene, const std::string& mission, const std::string& comment);

}  // namespace constrictor
