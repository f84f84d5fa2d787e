#include "bench/method_driver.hpp"

#include <stdexcept>

namespace constrictor {

MethodDriver::MethodDriver(const RobotModel& robot, const MethodTrial& trial)
    : robot_(robot),
      trial_(trial),
      chain_(robot),
      limiter_(robot, 1.0, trial.config.lead_s),
      method_(registry_.find(trial.method)) {
  if (!method_) throw std::invalid_argument("control has no method '" + trial.method + "'");
  desired_.speed_m_s = trial.frequency_hz * trial.config.travel.advance_m;
  gait_ = {trial.frequency_hz, trial.amplitude_rad, trial.wavelength_m, trial.curvature_1_m};
  if (!method_->accepts(desired_, chain_)) throw std::invalid_argument(trial.method + " does not accept the trial");
}

std::vector<JointSetpoint> MethodDriver::step(const JointArray& angle_rad, const JointArray& rate_rad_s,
                                              const Perceived& around, const JointArray& measured_nm) {
  const std::size_t n = robot_.joints.size();
  if (!started_ || torque_mode_) limit_.position_rad = angle_rad;
  const JointArray commanded_rad = limit_.position_rad;
  const MethodInput input{robot_,      chain_,        trial_.config,   desired_, gait_,      angle_rad,
                          measured_nm, commanded_rad, trial_.period_s, around,   rate_rad_s, exerted_nm_};
  if (!started_) method_->start(input, body_);
  started_ = true;
  Setpoints wanted;
  wanted.position_rad = commanded_rad;
  for (std::size_t j = 0; j < n; ++j) wanted.torque_limit_nm[j] = robot_.joints[j].max_torque_nm;
  method_->step(input, body_, wanted);
  wanted_rad_ = wanted.position_rad;
  torque_mode_ = wanted.torque_mode;
  const msg::JointCommand command = limiter_.limit(wanted, angle_rad, trial_.period_s, limit_);
  std::vector<JointSetpoint> setpoints(n);
  for (std::size_t j = 0; j < n; ++j) {
    setpoints[j] = {command.position_rad[j], command.velocity_rad_s[j], command.torque_limit_nm[j]};
    if (!torque_mode_) continue;
    const double torque_nm =
        safe_torque_nm(robot_.joints[j], command.torque_nm[j], angle_rad[j], rate_rad_s[j], trial_.period_s);
    setpoints[j] = {angle_rad[j], 0.0, command.torque_limit_nm[j], torque_nm, true};
    exerted_nm_[j] = torque_nm;
  }
  return setpoints;
}

}  // namespace constrictor
