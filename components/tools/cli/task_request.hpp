// Task requests and goals as people and scripts write and read them.
#pragma once

#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// Why no robot can do this task request, whatever it sees or holds: "rotate needs ..."; empty if it is complete.
std::string task_problem(const msg::Request& request);

/// A goal for people: the source's own number, "3", with the level of its source if that is no operator: "3 (planner)".
std::string goal_text(std::uint64_t goal);

}  // namespace constrictor::cli
