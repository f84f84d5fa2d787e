// The parameters of the report: one row each. report.yaml and the table in README.md follow from the rows.
#pragma once

#include "component/mission.hpp"
#include "configuration/parameter_set.hpp"

namespace constrictor {

struct ReportConfig : ParameterSet {
  double max_sim_time_s = add(max_sim_time_s, "max_sim_time_s", 900.0, "s", {0.1, 36000.0}, kAtStart,
                              "A mission that has not ended by then has failed; a longer limit of the scenario counts");
  double settle_s = add(settle_s, "settle_s", 2.0, "s", {0.0, 60.0}, kAtStart,
                        "Time from the end of the mission to the verdict, so that objects come to rest");
  int torque_decimation_ticks = add(torque_decimation_ticks, "torque_decimation_ticks", 5, "ticks", {1, 1000}, kAtStart,
                                    "Ticks from one sample of joint_torques.csv to the next");
  double torque_window_s = add(torque_window_s, "torque_window_s", 30.0, "s", {1.0, 600.0}, kAtStart,
                               "Time shown in each torque plot of the figure");

  /// Time limit of the run [s], and whose it is.
  struct Limit {
    double at_s = 0.0;
    const char* source = "";
  };
  /// A mission may state a longer limit than `max_sim_time_s`. The planner watches that limit, so the run must go on
  /// until the planner has ended the mission and the objects have come to rest.
  [[nodiscard]] Limit limit(const TimeLimits& stated) const {
    constexpr double kNotice_s = 1.0;  // until the planner's last word has arrived here
    const double mission_s = stated.mission_s.value_or(0.0) + kNotice_s + settle_s;
    if (!stated.mission_s || mission_s <= max_sim_time_s) return {max_sim_time_s, "max_sim_time_s of report"};
    return {mission_s, "mission_s of the scenario, with the time to settle"};
  }
};

}  // namespace constrictor
