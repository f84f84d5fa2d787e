// The components of a run, as they report themselves.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Reads the newest status of each component over a DDS participant: state, tick, process, host. Returns when no new
/// component has appeared for 300 ms, at most after `bound`.
std::map<std::string, msg::ComponentStatus> read_components(
    std::int32_t participant, std::chrono::milliseconds bound = std::chrono::milliseconds(1500));

}  // namespace constrictor
