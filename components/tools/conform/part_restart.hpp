// The checks "repeatable" and "restart" of a part: the same inputs are played to it again. In the second check its
// process is killed and started again meanwhile, and its answers must be those of a part that was not killed.
#pragma once

#include <functional>
#include <string>

#include "conform/part_port.hpp"
#include "conform/report.hpp"

namespace constrictor::conform {

/// Plays the inputs again, calls `disturb` between two ticks in their middle, and returns how the answers differ from
/// the first ones; empty: they do not.
using Repeat = std::function<std::string(const std::function<void()>& disturb)>;

/// Makes both checks. `differs`: the result of a repetition that was not disturbed. `equal`: what the report says of
/// answers that do not differ. `todo`: what to do if the repetition differs.
void judge_repetitions(
    Report& report, PartPort& port, const std::string& differs, const Repeat& repeat, const std::string& equal,
    const std::string& todo = "read no clock, and draw random numbers only from a generator with the run's seed");

/// The check "restart" in the list of a part's checks.
[[nodiscard]] Check restart_check();

}  // namespace constrictor::conform
