// The last step before the servos: no setpoint leaves the robot's limits.
#pragma once

#include <array>
#include <cstddef>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// A value for each joint of the robot, head to tail; elements beyond the count are zero.
using JointArray = std::array<double, msg::kMaxJoints>;

/// Setpoints of all joints as a method wants them.
struct Setpoints {
  JointArray position_rad{};
  JointArray torque_limit_nm{};
};

struct LimiterState {
  bool started = false;
  JointArray position_rad{};  ///< last setpoint
  template <class Archive>
  void serialize(Archive& archive) {
    archive(started);
    for (double& p : position_rad) archive(p);
  }
};

/// Bounds position, rate and torque of every setpoint by the robot's model. The first setpoint starts at the measured posture,
/// so that nothing jumps when control takes over. A wanted value that is not finite leaves that joint's setpoint where it was
/// (torque limit: the robot's own).
class JointLimiter {
 public:
  /// `speed_share`: part of the servos' maximum speed that a setpoint may use, 0..1.
  JointLimiter(const RobotModel& robot, double speed_share);

  /// `measured_rad`: joint positions, used at the first call only. `dt_s` > 0.
  msg::JointCommand limit(const Setpoints& wanted, const JointArray& measured_rad, double dt_s, LimiterState& state) const;
  /// Lets go: no torque, setpoints follow the measured posture.
  msg::JointCommand relax(const JointArray& measured_rad, LimiterState& state) const;

 private:
  const RobotModel& robot_;
  double speed_share_;
};

}  // namespace constrictor
