// What `--check` asks components about the robot, to find out before the start whether it suits the mission.
#pragma once

#include "component/check_verdict.hpp"

namespace constrictor {

/// A component that knows which robots it can deal with.
class RobotJudge {
 public:
  virtual ~RobotJudge() = default;
  /// A text about the configuration of the component begins with its name and a colon.
  [[nodiscard]] virtual CheckVerdict judge_robot() const = 0;
};

}  // namespace constrictor
