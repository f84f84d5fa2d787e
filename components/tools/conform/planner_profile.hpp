// The expectations of `constrictor conform planner`: one row for each value.
#pragma once

#include "configuration/parameter_set.hpp"

namespace constrictor::conform {

struct PlannerProfile : ParameterSet {
  double patience_s =
      add(patience_s, "patience_s", 2.0, "s", {0.02, 60.0}, kAtStart, "Time to wait for the first mission_status");
  double decide_s = add(decide_s, "decide_s", 3.0, "s", {0.1, 600.0}, kAtStart,
                        "Time in which the planner reacts to what it sees and to events");
  double repeat_s = add(repeat_s, "repeat_s", 6.0, "s", {0.5, 600.0}, kAtStart,
                        "Time in which a request that nobody takes is made again");
  double way_s = add(way_s, "way_s", 20.0, "s", {0.0, 600.0}, kAtStart,
                     "Time for which the robot follows the line before it sees an object or a zone");
  double turn_s = add(turn_s, "turn_s", 60.0, "s", {1.0, 600.0}, kAtStart,
                      "Time in which the planner turns the robot towards the line");
  double end_s = add(end_s, "end_s", 60.0, "s", {1.0, 600.0}, kAtStart,
                     "Time in which the mission ends after the last object was dropped");
  int most_requests = add(most_requests, "most_requests", 10, "1/s", {1, 200}, kAtStart, "Most requests in any second");
};

}  // namespace constrictor::conform
