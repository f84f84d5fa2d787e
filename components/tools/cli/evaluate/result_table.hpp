// The results of an evaluation as a table for the terminal.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/evaluate/summary.hpp"

namespace constrictor::cli {

/// A row for each variant, what the columns mean, and the longest recovery of all runs. A table wider than `columns`
/// has the names of the variants on lines of their own. What no run shows (errors, runs that were refused, successes
/// that only the robot believed, or that it did not notice) has no column.
[[nodiscard]] std::string to_table(const std::vector<VariantSummary>& summaries, std::size_t columns);

}  // namespace constrictor::cli
