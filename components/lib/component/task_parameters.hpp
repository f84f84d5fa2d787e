// Which parameters each task needs, whatever the robot sees or holds. `input` checks them before a request takes
// authority, navigation before it starts a goal, and clients may check them before they send a request.
#pragma once

#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Why a task of this kind cannot start with these parameters: a text for people that names what was found and what is
/// accepted. Empty if the parameters are complete. Navigation decides whether the robot can do the task at present.
[[nodiscard]] std::string task_parameter_refusal(std::uint8_t task, const msg::TaskParameters& parameters,
                                                 const msg::Path& path);

}  // namespace constrictor
