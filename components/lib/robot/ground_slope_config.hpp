// The parameters of GroundSlope: guidance and perception each keep the slope from the same attitudes.
#pragma once

#include "configuration/parameter_set.hpp"

namespace constrictor {

struct GroundSlopeConfig : ParameterSet {
  double slope_time_s = add(slope_time_s, "slope_time_s", 4.0, "s", {0.0, 600.0}, kWhileRunning,
                            "Time constant of the mean that finds the slope; 0: the ground is level");
  double level_rad = add(level_rad, "level_rad", 0.015, "rad", {0.0, 0.3}, kWhileRunning,
                         "Ground that is inclined by less than this counts as level");
};

}  // namespace constrictor
