#include "robot/servo_guard.hpp"

namespace constrictor {

ServoGuard::ServoGuard(const RobotModel& robot, ServoGuardLimits limits)
    : joints_(robot.joints), limits_(limits), offered_(robot.joints.size()), setpoints_(robot.joints.size()) {}

std::string_view ServoGuard::offer(std::int64_t age_ticks, std::span<const double> position_rad,
                                   std::span<const double> velocity_rad_s, std::span<const double> torque_limit_nm) {
  // Staleness is silence, not a mistake: it is not counted.
  if (age_ticks > limits_.stale_after_ticks) return "stale";
  if (position_rad.size() != joints_.size() || velocity_rad_s.size() != joints_.size() ||
      torque_limit_nm.size() != joints_.size()) {
    ++refused_;
    return "wrong number of joints";
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const JointSetpoint setpoint{position_rad[i], velocity_rad_s[i], torque_limit_nm[i]};
    if (!is_acceptable(joints_[i], setpoint)) {
      ++refused_;
      return "a setpoint is not finite or beyond the joint's limits";
    }
    offered_[i] = clamp_to_limits(joints_[i], setpoint);
  }
  accepted_ = true;
  return {};
}

const std::vector<JointSetpoint>& ServoGuard::setpoints(std::span<const double> measured_rad) {
  if (accepted_) {
    accepted_ = false;
    silent_ticks_ = 0;
    posture_known_ = false;
    mode_ = Mode::kObeying;
    setpoints_ = offered_;
    return setpoints_;
  }
  ++silent_ticks_;
  mode_ = silent_ticks_ > limits_.relax_after_ticks ? Mode::kRelaxed : Mode::kHolding;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    if (!posture_known_) setpoints_[i].position_rad = measured_rad[i];
    setpoints_[i].velocity_rad_s = 0.0;
    setpoints_[i].torque_limit_nm = mode_ == Mode::kRelaxed ? 0.0 : joints_[i].max_torque_nm;
    setpoints_[i] = clamp_to_limits(joints_[i], setpoints_[i]);
  }
  posture_known_ = true;
  return setpoints_;
}

}  // namespace constrictor
