// Names of tasks, events, colours and directions for people and scripts. Their words are joined by a blank, "-" or "_".
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "constrictor/description.hpp"
#include "constrictor/messages.hpp"

namespace constrictor {

const char* task_word(std::uint8_t task);         ///< "follow_line"
const char* event_name(std::uint8_t event);       ///< "line_lost"
const char* goal_state_name(std::uint8_t state);  ///< "succeeded"
const char* authority_name(std::uint8_t level);   ///< "operator"

/// All names, joined by commas.
std::string task_words();
std::string event_words();
std::string colour_words();
std::string direction_words();

/// The value with this name; empty if there is none.
std::optional<std::uint8_t> task_by_name(const std::string& name);
std::optional<std::uint8_t> event_by_name(const std::string& name);

/// A parameter that is a positive number. Its name and its bound are those of the IDL.
struct TaskNumber {
  FieldInfo info;
  const char* unit;  ///< in words, plural
  double msg::TaskParameters::*field;
  [[nodiscard]] bool accepts(double number) const { return number > 0.0 && number <= info.max; }
  [[nodiscard]] std::string accepted() const;  ///< for error messages
};
std::span<const TaskNumber> task_numbers();

/// Sets one parameter, for example "line_colour" to "blue". Returns the problem; empty: none.
std::string set_task_parameter(msg::TaskParameters& parameters, const std::string& key, const std::string& value);
/// Sets a path from points "X,Y" [m]; no points: no path. Returns the problem; empty: none.
std::string set_path(msg::Path& path, const std::vector<std::string>& points);
/// Reads a task from one line: "follow_line line_colour=blue", "follow_path path=0,0;1,0.5". Returns the problem;
/// empty: none.
std::string parse_task(const std::string& line, std::uint8_t& task, msg::TaskParameters& parameters, msg::Path& path);

}  // namespace constrictor
