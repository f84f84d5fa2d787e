// The planner's recoveries in one run: their causes and how long they took, as far as report.json tells.
#pragma once

#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/evaluate/report_fields.hpp"

namespace constrictor::cli {

/// Times after which the planner counts a recovery without an event. In a search for the line it stays in its state.
struct SearchLimits {
  double empty_s = std::numeric_limits<double>::infinity();    ///< without an object
  double holding_s = std::numeric_limits<double>::infinity();  ///< with one
  double inspect_s = std::numeric_limits<double>::infinity();  ///< of a look at a dropped object
};

/// One time from a loss until the mission goes on.
struct RecoveryTime {
  double begin_s = kUnknown;     ///< simulated time
  double duration_s = kUnknown;  ///< NaN: the run has no recovery whose time is known
  std::string cause;             ///< of its first loss
};

struct Recoveries {
  /// How many recoveries the planner has counted by state and cause, such as "follow line: line lost". Those of which
  /// the report shows no cause are "other". The sum is the report's number of recoveries.
  std::map<std::string, int> by_cause;
  RecoveryTime longest;
};

/// Derives each recovery of the built-in planner from the change of its state (`states`) and from the events of the
/// goal that ended then (`events`). `end_s`: end of the mission.
[[nodiscard]] Recoveries recoveries_of(const nlohmann::json& report, double end_s, const SearchLimits& limits);

/// The stay of the planner in a state.
struct StateStay {
  std::string state;
  double begin_s = 0;
  double end_s = 0;
};

/// The stays in their order. The last one ends at `end_s`. Damaged entries are left out.
[[nodiscard]] std::vector<StateStay> stays_of(const nlohmann::json& report, double end_s);

}  // namespace constrictor::cli
