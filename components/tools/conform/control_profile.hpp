// The expectations of `constrictor conform control`, and the values of its checks: one row for each value.
#pragma once

#include "configuration/parameter_set.hpp"

namespace constrictor::conform {

struct ControlProfile : ParameterSet {
  double patience_s =
      add(patience_s, "patience_s", 2.0, "s", {0.1, 60.0}, kAtStart, "Time to wait for the first command");
  double answer_s = add(answer_s, "answer_s", 0.2, "s", {0.02, 5.0}, kAtStart,
                        "Time after which motion_status shows a new trajectory");
  double posture_rad = add(posture_rad, "tolerance.posture_rad", 0.02, "rad", {0.0001, 0.3}, kAtStart,
                           "A setpoint differs from the posture that is demanded by less than this");
  double gain_tolerance = add(gain_tolerance, "tolerance.gain", 0.35, "", {0.01, 0.9}, kAtStart,
                              "Frequencies, curvatures and rates may be wrong by this share");
  double speed_m_s = add(speed_m_s, "motion.speed_m_s", 0.45, "m/s", {0.05, 2.0}, kAtStart, "Along the path");
  double curvature_1_m = add(curvature_1_m, "motion.curvature_1_m", 0.8, "1/m", {0.1, 3.0}, kAtStart, "Of the path");
  double settle_s = add(settle_s, "motion.settle_s", 4.0, "s", {0.5, 60.0}, kAtStart,
                        "Time in which speed and curvature reach what is demanded");
  double hold_within_s = add(hold_within_s, "hold_within_s", 0.5, "s", {0.02, 10.0}, kAtStart,
                             "Time after which the setpoints rest when trajectories or authority end");
  double relax_within_s = add(relax_within_s, "relax_within_s", 10.0, "s", {0.1, 600.0}, kAtStart,
                              "Time after which the joints are relaxed when trajectories end");
};

}  // namespace constrictor::conform
