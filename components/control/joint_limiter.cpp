#include "control/joint_limiter.hpp"

#include <algorithm>
#include <cmath>

#include "robot/joint_limits.hpp"

namespace constrictor {
namespace {

double limit_nm(const JointModel& joint, double wanted_nm) {
  return std::isfinite(wanted_nm) ? std::clamp(wanted_nm, 0.0, joint.max_torque_nm) : joint.max_torque_nm;
}

}  // namespace

JointLimiter::JointLimiter(const RobotModel& robot, double speed_share) : robot_(robot), speed_share_(speed_share) {}

msg::JointCommand JointLimiter::limit(const Setpoints& wanted, const JointArray& measured_rad, double dt_s,
                                      LimiterState& state) const {
  if (wanted.torque_mode) return exert(wanted, measured_rad, state);
  msg::JointCommand command{};
  command.joint_count = static_cast<std::uint16_t>(robot_.joints.size());
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const JointModel& joint = robot_.joints[j];
    if (!state.started)
      state.position_rad[j] = clamp_position(joint, std::isfinite(measured_rad[j]) ? measured_rad[j] : 0.0);
    const double previous_rad = state.position_rad[j];
    const double target_rad =
        std::isfinite(wanted.position_rad[j]) ? clamp_position(joint, wanted.position_rad[j]) : previous_rad;
    const double step_rad = speed_share_ * joint.max_speed_rad_s * dt_s;
    const double position_rad = std::clamp(target_rad, previous_rad - step_rad, previous_rad + step_rad);
    command.position_rad[j] = position_rad;
    command.velocity_rad_s[j] = (position_rad - previous_rad) / dt_s;
    command.torque_limit_nm[j] = limit_nm(joint, wanted.torque_limit_nm[j]);
    state.position_rad[j] = position_rad;
  }
  state.started = true;
  return command;
}

msg::JointCommand JointLimiter::exert(const Setpoints& wanted, const JointArray& measured_rad,
                                      LimiterState& state) const {
  msg::JointCommand command = relax(measured_rad, state);
  command.mode = msg::kServoTorque;
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    const double limit = limit_nm(robot_.joints[j], wanted.torque_limit_nm[j]);
    command.torque_limit_nm[j] = limit;
    if (std::isfinite(wanted.torque_nm[j])) command.torque_nm[j] = std::clamp(wanted.torque_nm[j], -limit, limit);
  }
  return command;
}

msg::JointCommand JointLimiter::relax(const JointArray& measured_rad, LimiterState& state) const {
  msg::JointCommand command{};
  command.joint_count = static_cast<std::uint16_t>(robot_.joints.size());
  for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
    if (std::isfinite(measured_rad[j])) state.position_rad[j] = clamp_position(robot_.joints[j], measured_rad[j]);
    command.position_rad[j] = state.position_rad[j];
  }
  state.started = true;
  return command;
}

}  // namespace constrictor
