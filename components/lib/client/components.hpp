// The components of a run, as they report themselves.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// The newest messages of a member of the barrier about itself; those of its newest incarnation.
struct ComponentMessages {
  std::optional<msg::Hello> hello;
  std::optional<msg::ComponentStatus> status;
};

/// Reads the newest messages of each component over a DDS participant. Returns when nothing new has arrived for 300 ms,
/// at most after `bound`.
std::map<std::string, ComponentMessages> read_component_messages(
    std::int32_t participant, std::chrono::milliseconds bound = std::chrono::milliseconds(1500));

/// Reads the newest status of each component: state, tick, process, host. Waits for the first component, then as
/// read_component_messages() does.
std::map<std::string, msg::ComponentStatus> read_components(
    std::int32_t participant, std::chrono::milliseconds bound = std::chrono::milliseconds(1500));

}  // namespace constrictor
