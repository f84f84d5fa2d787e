// The paper's object handle identifies the object of a colour that a goal means. It is the handle of guidance's map.
#pragma once

#include <cstdint>
#include <string>

#include "navigation/task.hpp"

namespace constrictor {

/// Handle of the object of this colour that counts (take_places); 0: the map has none.
[[nodiscard]] std::uint16_t seen_handle(const TaskInput& input, std::uint8_t colour);

/// The object of the map that the goal names; null: it names none, or the map does not have it.
[[nodiscard]] const msg::MapObject* named_object(const TaskInput& input);

/// Whether the last seen object of the goal's colour is the object that the goal names. A goal without a handle means
/// any object of its colour.
[[nodiscard]] bool is_named(const TaskInput& input);

/// Why a goal is refused that names an object: the map has no object of this handle and colour. Empty: it is accepted.
[[nodiscard]] std::string handle_refusal(const TaskInput& input);

}  // namespace constrictor
