// The paper's object handle: which object of a colour is meant. It is that of guidance's map, made from percepts and touch.
#pragma once

#include <cstdint>
#include <string>

#include "navigation/task.hpp"

namespace constrictor {

/// Handle of the map's object of this colour that is where navigation saw it last; 0: the map has none there (yet).
[[nodiscard]] std::uint16_t seen_handle(const TaskInput& input, std::uint8_t colour);

/// Whether what was seen last of the goal's colour is the object that the goal names; a goal that names none means any.
[[nodiscard]] bool is_named(const TaskInput& input);

/// Why a goal that names an object cannot be accepted: the map has no such object of the goal's colour. Empty: it can.
[[nodiscard]] std::string handle_refusal(const TaskInput& input);

}  // namespace constrictor
