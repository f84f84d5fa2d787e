// Tasks, events, colours and directions by name, as people and scripts write them: words joined by a blank, "-" or "_".
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor::cli {

const char* task_word(std::uint8_t task);             ///< "follow_line"
const char* event_name(std::uint8_t event);           ///< "line lost"
const char* goal_state_name(std::uint8_t state);      ///< "succeeded"
const char* authority_name(std::uint8_t level);       ///< "operator"

/// Empty if there is none of that name.
std::optional<std::uint8_t> task_by_name(const std::string& name);
std::optional<std::uint8_t> event_by_name(const std::string& name);

/// Sets one parameter, "line_colour" to "blue". Returns what is wrong, empty if nothing.
std::string set_task_parameter(msg::TaskParameters& parameters, const std::string& key, const std::string& value);
/// A whole task as one line: "follow_line line_colour=blue". Returns what is wrong, empty if nothing.
std::string parse_task(const std::string& line, std::uint8_t& task, msg::TaskParameters& parameters);

}  // namespace constrictor::cli
