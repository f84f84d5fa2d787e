// The limits of a joint. Control never demands more, and the plant never obeys more.
#pragma once

#include "robot/robot_model.hpp"

namespace constrictor {

/// The setpoint of one joint. An entry that is not finite makes it unacceptable.
struct JointSetpoint {
  double position_rad = 0.0;
  double velocity_rad_s = 0.0;   ///< feed-forward
  double torque_limit_nm = 0.0;  ///< 0 relaxes the joint
  template <class Archive>
  void serialize(Archive& archive) {
    archive(position_rad, velocity_rad_s, torque_limit_nm);
  }
};

/// True if every entry is finite, the position within the joint's limits (plus 1e-9 rad for rounding), and the torque
/// limit not negative. Speed and torque beyond the joint's own are acceptable: they are clamped.
[[nodiscard]] bool is_acceptable(const JointModel& joint, const JointSetpoint& setpoint);

/// The nearest position within the joint's limits. Expects a finite position.
[[nodiscard]] double clamp_position(const JointModel& joint, double position_rad);

/// The nearest setpoint that the joint can follow. Expects finite entries.
[[nodiscard]] JointSetpoint clamp_to_limits(const JointModel& joint, const JointSetpoint& setpoint);

}  // namespace constrictor
