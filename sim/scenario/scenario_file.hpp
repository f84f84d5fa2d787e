// Scenario files: a YAML description of a scene with what the seed may vary. See README.md for the keys.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "configuration/configuration.hpp"
#include "sim/scenario/scenario.hpp"

namespace constrictor {

/// Reads a scenario, checks it and applies the seed's variation. Equal arguments give equal scenes. Throws ConfigurationError, also
/// if bodies overlap, or if the variation leaves hardly any room without overlaps.
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file, std::uint64_t seed);

/// The same from a parsed file.
[[nodiscard]] Scenario read_scenario(Configuration root, std::uint64_t seed);

}  // namespace constrictor
