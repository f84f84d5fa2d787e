#include "robot/joint_limits.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {

bool is_acceptable(const JointModel& joint, const JointSetpoint& setpoint) {
  constexpr double kRounding_rad = 1e-9;
  return std::isfinite(setpoint.position_rad) && std::isfinite(setpoint.velocity_rad_s) &&
         std::isfinite(setpoint.torque_limit_nm) && setpoint.position_rad >= joint.min_rad - kRounding_rad &&
         setpoint.position_rad <= joint.max_rad + kRounding_rad && setpoint.torque_limit_nm >= 0.0;
}

double clamp_position(const JointModel& joint, double position_rad) {
  return std::clamp(position_rad, joint.min_rad, joint.max_rad);
}

JointSetpoint clamp_to_limits(const JointModel& joint, const JointSetpoint& setpoint) {
  return {clamp_position(joint, setpoint.position_rad),
          std::clamp(setpoint.velocity_rad_s, -joint.max_speed_rad_s, joint.max_speed_rad_s),
          std::clamp(setpoint.torque_limit_nm, 0.0, joint.max_torque_nm)};
}

}  // namespace constrictor
