#include "robot/joint_limits.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {

bool is_acceptable(const JointModel& joint, const JointSetpoint& setpoint) {
  constexpr double kRounding_rad = 1e-9;
  if (!std::isfinite(setpoint.position_rad) || !std::isfinite(setpoint.velocity_rad_s) ||
      !std::isfinite(setpoint.torque_limit_nm) || !std::isfinite(setpoint.torque_nm) || setpoint.torque_limit_nm < 0.0)
    return false;
  return setpoint.torque_mode || (setpoint.position_rad >= joint.min_rad - kRounding_rad &&
                                  setpoint.position_rad <= joint.max_rad + kRounding_rad);
}

double clamp_position(const JointModel& joint, double position_rad) {
  return std::clamp(position_rad, joint.min_rad, joint.max_rad);
}

JointSetpoint clamp_to_limits(const JointModel& joint, const JointSetpoint& setpoint) {
  const double limit_nm = std::clamp(setpoint.torque_limit_nm, 0.0, joint.max_torque_nm);
  return {clamp_position(joint, setpoint.position_rad),
          std::clamp(setpoint.velocity_rad_s, -joint.max_speed_rad_s, joint.max_speed_rad_s), limit_nm,
          std::clamp(setpoint.torque_nm, -limit_nm, limit_nm), setpoint.torque_mode};
}

double safe_torque_nm(const JointModel& joint, double torque_nm, double angle_rad, double rate_rad_s, double dt_s) {
  constexpr double kFullUpTo = 0.75;  // share of the maximum speed
  if (!std::isfinite(angle_rad) || !std::isfinite(rate_rad_s)) return 0.0;
  const double next_rad = angle_rad + rate_rad_s * dt_s;
  if (torque_nm > 0.0 && std::max(angle_rad, next_rad) >= joint.max_rad) return 0.0;
  if (torque_nm < 0.0 && std::min(angle_rad, next_rad) <= joint.min_rad) return 0.0;
  if (torque_nm * rate_rad_s <= 0.0) return torque_nm;
  const double speed_share = std::abs(rate_rad_s) / joint.max_speed_rad_s;
  const double most_nm = joint.max_torque_nm * std::clamp((1.0 - speed_share) / (1.0 - kFullUpTo), 0.0, 1.0);
  return std::clamp(torque_nm, -most_nm, most_nm);
}

}  // namespace constrictor
