// Limits the setpoints of the methods to what the joints of the robot can follow.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "constrictor/messages.hpp"
#include "robot/robot_model.hpp"

namespace constrictor {

/// A value for each joint of the robot, head to tail; elements beyond the count are zero.
using JointArray = std::array<double, msg::kMaxJoints>;

/// The setpoints of all joints that a method demands: angles, or in torque mode torques.
struct Setpoints {
  JointArray position_rad{};
  JointArray torque_limit_nm{};
  JointArray torque_nm{};    ///< used in torque mode only; sign as in JointState
  bool torque_mode = false;  ///< all joints exert torque_nm
};

struct LimiterState {
  bool started = false;
  JointArray position_rad{};     ///< last setpoint
  JointArray torque_limit_nm{};  ///< last limit
  template <class Archive>
  void serialize(Archive& archive) {
    archive(started);
    for (double& p : position_rad) archive(p);
    for (double& limit : torque_limit_nm) archive(limit);
  }
};

/// Limits position, rate and torque of every setpoint to the limits in the robot's model. The first setpoint starts at
/// the measured posture, so that the body does not jump when control starts. Where a demanded position is not finite,
/// the joint keeps its setpoint; where a torque limit is not finite, the robot's own limit applies; where a torque is
/// not finite, the joint exerts none.
///
/// A low torque limit can keep a joint away from its setpoint. The joint would jump there when the limit rises, faster
/// than the robot's limit. Its setpoint therefore first returns to the angle at which the servo exerts the old limit,
/// and the limit rises when the setpoint has arrived, or is within 0.1 rad of the joint.
///
/// A joint that is pressed against something does not follow at all. Its setpoint waits for it at the lead at which the
/// servo exerts the whole torque limit, plus the distance that the joint covers at full speed in `lead_s`. A farther
/// setpoint would add no torque, and the joint would catch up with it too fast when it comes free.
class JointLimiter {
 public:
  /// `speed_share`: share of the servos' maximum speed that the setpoints may use, 0 to 1. `lead_s` [s] >= 0.
  JointLimiter(const RobotModel& robot, double speed_share, double lead_s);

  /// `measured_rad`: joint positions; one that is not finite bounds no setpoint. `dt_s` > 0.
  msg::JointCommand limit(const Setpoints& wanted, const JointArray& measured_rad, double dt_s,
                          LimiterState& state) const;
  /// The command that exerts torques; the setpoints follow the measured posture.
  msg::JointCommand exert(const Setpoints& wanted, const JointArray& measured_rad, LimiterState& state) const;
  /// Relaxes the joints: no torque; the setpoints follow the measured posture.
  msg::JointCommand relax(const JointArray& measured_rad, LimiterState& state) const;

 private:
  /// The setpoint to which joint `j` must return before its torque limit rises to `limit_nm`; empty if it may stay.
  [[nodiscard]] std::optional<double> before_rise(std::size_t j, double limit_nm, double measured_rad,
                                                  const LimiterState& state) const;

  /// [rad] How far the setpoint of a joint may be ahead of it at this torque limit.
  [[nodiscard]] double lead_rad(const JointModel& joint, double torque_limit_nm) const;

  const RobotModel& robot_;
  double speed_share_;
  double lead_s_;
};

}  // namespace constrictor
