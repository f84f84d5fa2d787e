#include "cli/evaluate/search_limits.hpp"

#include <algorithm>

#include "cli/evaluate/variation.hpp"
#include "component/mission.hpp"
#include "configuration/configuration.hpp"

namespace constrictor::cli {

SearchLimits search_limits_of(const RunOptions& options) {
  const LaunchPlan plan = make_launch_plan(options);
  if (std::find(plan.roster.begin(), plan.roster.end(), "planner") == plan.roster.end()) return {};
  try {
    Configuration planner = Configuration::load(config_file_of("planner", plan));
    double search_s = planner.number("search_timeout_s", {1, 1e6});
    const double holding_factor = planner.number("holding_factor", {1, 1e6});
    const double inspect_s =
        planner.has("inspect_s") ? planner.number("inspect_s", {1, 1e6}) : SearchLimits{}.inspect_s;
    Configuration scenario = Configuration::load(plan.manifest.scenario_file);
    if (scenario.has("mission"))
      search_s = read_mission(scenario.section("mission")).limits.search_s.value_or(search_s);
    return {search_s, search_s * holding_factor, inspect_s};
  } catch (const ConfigurationError&) {
    return {};
  }
}

}  // namespace constrictor::cli
