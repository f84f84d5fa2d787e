// The attempts to retrieve an object: each differs from all earlier ones.
#pragma once

#include <cereal/types/string.hpp>
#include <cstdint>
#include <string>

#include "constrictor/messages.hpp"

namespace constrictor {

/// What was tried with one object of the mission. It is kept while the object is put aside, so that the attempt at the
/// end is a new one, too.
struct Attempts {
  int failures = 0;                         ///< approaches, grasps, transports and drops that failed
  std::uint8_t side = msg::kDirectionNone;  ///< on which the last pregrasp passed the object: left or right
  std::string reason;                       ///< of the last failure
  template <class Archive>
  void serialize(Archive& archive) {
    archive(failures, side, reason);
  }
};

/// How an attempt passes the object and wraps the body round it: parameters of pregrasp and grasp, with the same
/// meaning (msg::TaskParameters).
struct Way {
  std::uint8_t direction = msg::kDirectionNone;
  double clearance_m = 0.0;
  double wrap_scale = 0.0;
};

/// The next attempt. The first one leaves everything to navigation. Each further one passes the object on the other
/// side; from the third one on, the distance and the width of the wrap change with every second attempt.
[[nodiscard]] Way next_way(const Attempts& attempts);

/// The direction in which the robot leaves the object before the next approach, so that this comes from elsewhere:
/// backwards, left and right in turn. Together with next_way(), no two of thirty attempts are equal.
[[nodiscard]] std::uint8_t next_departure(const Attempts& attempts);

}  // namespace constrictor
