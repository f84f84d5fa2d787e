// The parameters of the report: one row each. report.yaml and the table in README.md follow from the rows.
#pragma once

#include "configuration/parameter_set.hpp"

namespace constrictor {

struct ReportConfig : ParameterSet {
  double max_sim_time_s = add(max_sim_time_s, "max_sim_time_s", 900.0, "s", {0.1, 36000.0}, kAtStart,
                              "A mission that has not ended by then has failed");
  double settle_s = add(settle_s, "settle_s", 2.0, "s", {0.0, 60.0}, kAtStart,
                        "Time from the end of the mission to the verdict, so that objects come to rest");
  int torque_decimation_ticks = add(torque_decimation_ticks, "torque_decimation_ticks", 5, "ticks", {1, 1000}, kAtStart,
                                    "Ticks from one sample of joint_torques.csv to the next");
  double torque_window_s = add(torque_window_s, "torque_window_s", 30.0, "s", {1.0, 600.0}, kAtStart,
                               "Time shown in each torque plot of the figure");
};

}  // namespace constrictor
