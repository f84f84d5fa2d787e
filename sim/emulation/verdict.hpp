// Whether a mission has really succeeded, judged by the emulated world alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/world/world.hpp"

namespace constrictor::emulation {

/// The colours (msg::kColour…) of the mission of a scenario file, in their order. Throws ConfigurationError.
[[nodiscard]] std::vector<std::uint8_t> mission_sequence(const std::filesystem::path& scenario_file);

/// The content of truth.json, README.md has its keys. The mission has succeeded if for each entry of `sequence` an
/// object of this colour lies with its centre in a zone of this colour; without objects to retrieve, if the head is at
/// the end of the line.
[[nodiscard]] std::string verdict_json(const World& world, const std::vector<std::uint8_t>& sequence,
                                       std::int64_t left_out_ns);

}  // namespace constrictor::emulation
