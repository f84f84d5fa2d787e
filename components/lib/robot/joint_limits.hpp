// The limits of a joint. Control never demands more, and the plant never accepts more.
#pragma once

#include "robot/robot_model.hpp"

namespace constrictor {

/// [rad] A joint nearer than this to its setpoint follows it. A hold then keeps the setpoint, because otherwise a
/// loaded servo would creep by its own error with each new hold.
inline constexpr double kAgreement_rad = 0.1;

/// The setpoint of one joint. An entry that is not finite makes it unacceptable.
struct JointSetpoint {
  double position_rad = 0.0;     ///< in torque mode: the angle at which a hold would begin
  double velocity_rad_s = 0.0;   ///< feed-forward; in torque mode 0
  double torque_limit_nm = 0.0;  ///< 0 relaxes the joint
  double torque_nm = 0.0;        ///< torque that the joint exerts in torque mode, at most torque_limit_nm; else 0
  bool torque_mode = false;      ///< the joint exerts torque_nm; else it moves to position_rad
  template <class Archive>
  void serialize(Archive& archive) {
    archive(position_rad, velocity_rad_s, torque_limit_nm, torque_nm, torque_mode);
  }
};

/// True if every entry is finite, the position within the joint's limits (plus 1e-9 rad for rounding), and the torque
/// limit not negative. Speed and torque beyond the joint's own are acceptable: they are clamped. In torque mode the
/// position may be any finite one.
[[nodiscard]] bool is_acceptable(const JointModel& joint, const JointSetpoint& setpoint);

/// The nearest position within the joint's limits. Expects a finite position.
[[nodiscard]] double clamp_position(const JointModel& joint, double position_rad);

/// The nearest setpoint that the joint can follow. Expects finite entries.
[[nodiscard]] JointSetpoint clamp_to_limits(const JointModel& joint, const JointSetpoint& setpoint);

/// The part of `torque_nm` that a joint with this angle and rate may exert for the next `dt_s`. Torque that brakes the
/// joint, or turns it away from a limit, stays. Torque along the motion is at most the joint's own up to three quarters
/// of its maximum speed; this bound falls to 0 at the maximum speed. Torque towards a limit of the position becomes 0
/// as soon as the joint would reach this limit within `dt_s` at its present rate. An angle or a rate that is not finite
/// leaves no torque.
[[nodiscard]] double safe_torque_nm(const JointModel& joint, double torque_nm, double angle_rad, double rate_rad_s,
                                    double dt_s);

}  // namespace constrictor
