// What `--check` asks components about the robot, to find out before the start whether it can move.
#pragma once

#include <string>
#include <vector>

namespace constrictor {

/// What a component finds wrong with the robot, for people: key of the robot file, found, accepted and reason.
struct RobotVerdict {
  std::vector<std::string> refusals;  ///< why it does not move
  std::vector<std::string> warnings;  ///< why it hardly moves
};

/// A component that knows which robots it can move.
class RobotJudge {
 public:
  virtual ~RobotJudge() = default;
  [[nodiscard]] virtual RobotVerdict judge_robot() const = 0;
};

}  // namespace constrictor
