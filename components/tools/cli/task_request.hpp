// Goals as people and scripts read them.
#pragma once

#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor::cli {

/// A goal as text for people: the number that its source gave it, "3". If the source is not an operator, its level is
/// added: "3 (planner)".
std::string goal_text(std::uint64_t goal);

}  // namespace constrictor::cli
