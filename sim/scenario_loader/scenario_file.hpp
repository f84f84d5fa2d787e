// Reads scenario files: YAML descriptions of a scene and of its variation by the seed. README.md has the table of keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "configuration/configuration.hpp"
#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

/// Reads and checks a scenario file, and draws the variation with the seed. Equal arguments give equal scenes. Throws
/// ConfigurationError, also if bodies overlap, or if 200 draws of the variation all have overlaps.
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file, std::uint64_t seed);

/// The same for a parsed file.
[[nodiscard]] Scenario read_scenario(const Configuration& root, std::uint64_t seed);

/// The same, for a robot whose straight body has this length [m] and half width [m]: also throws if this body overlaps
/// something at the start. The scene does not depend on the robot.
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file, std::uint64_t seed, double body_length_m,
                                     double body_half_width_m);

}  // namespace constrictor
