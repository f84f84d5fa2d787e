#include "cli/task_request.hpp"

#include <fmt/format.h>

#include "client/goal_tracker.hpp"
#include "client/task_names.hpp"

namespace constrictor::cli {

std::string goal_text(std::uint64_t goal) {
  if (goal_level(goal) == msg::kAuthorityOperator) return std::to_string(goal_number(goal));
  return fmt::format("{} ({})", goal_number(goal), authority_name(goal_level(goal)));
}

}  // namespace constrictor::cli
