// Which parameters each task needs, whatever the robot sees or holds. `input` checks them before a request takes
// authority, navigation before it starts a goal, and clients may check them before they send a request.
#pragma once

#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Why no task of this kind can start with these parameters: what was found and what is accepted, for people. Empty:
/// the parameters are complete. Whether the robot can do the task now, navigation decides.
[[nodiscard]] std::string task_parameter_refusal(std::uint8_t task, const msg::TaskParameters& parameters,
                                                 const msg::Path& path);

}  // namespace constrictor
