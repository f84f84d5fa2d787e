#include "servo_bus/stuck_watch.hpp"

#include <algorithm>

namespace constrictor {

void StuckWatch::Range::add(double value, bool first) {
  min = first ? value : std::min(min, value);
  max = first ? value : std::max(max, value);
}

std::vector<StuckWatch::Change> StuckWatch::look(std::span<const JointSetpoint> goals,
                                                 std::span<const double> angles_rad) {
  std::vector<Change> changes;
  if (window_ticks_ == 0) return changes;
  const bool first = ticks_ == 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    joint.goal.add(goals[i].position_rad, first);
    joint.angle.add(angles_rad[i], first);
    joint.driven = (first || joint.driven) && goals[i].torque_limit_nm > 0.0 && !goals[i].torque_mode;
  }
  if (++ticks_ < window_ticks_) return changes;
  ticks_ = 0;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    const bool still = joint.driven && joint.goal.width() > kGoalMoves_rad && joint.angle.width() < kStill_rad;
    const bool moves = joint.angle.width() > kMoves_rad;
    if (joint.stuck ? !moves : !still) continue;
    joint.stuck = !joint.stuck;
    changes.push_back({i, joint.stuck, joint.goal.width()});
  }
  return changes;
}

}  // namespace constrictor
