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

JointLimiter::JointLimiter(const RobotModel& robot, double speed_share, double lead_s)
    : robot_(robot), speed_share_(speed_share), lead_s_(lead_s) {}

double JointLimiter::lead_rad(const JointModel& joint, double torque_limit_nm) const {
  const double spring_rad = joint.stiffness_nm_rad > 0.0 ? torque_limit_nm / joint.stiffness_nm_rad : 0.0;
  return torque_limit_nm / joint.position_gain_nm_rad + spring_rad + joint.max_speed_rad_s * lead_s_;
}

std::optional<double> JointLimiter::before_rise(std::size_t j, double limit_nm, double measured_rad,
                                                const LimiterState& state) const {
  const double before_nm = state.torque_limit_nm[j];
  const double apart_rad = state.position_rad[j] - measured_rad;
  const double reach_rad = before_nm / robot_.joints[j].position_gain_nm_rad;
  if (!(limit_nm > before_nm && std::abs(apart_rad) > std::max(kAgreement_rad, reach_rad))) return std::nullopt;
  return clamp_position(robot_.joints[j], measured_rad + std::copysign(reach_rad, apart_rad));
}

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
    double target_rad =
        std::isfinite(wanted.position_rad[j]) ? clamp_position(joint, wanted.position_rad[j]) : previous_rad;
    double torque_limit_nm = limit_nm(joint, wanted.torque_limit_nm[j]);
    if (!state.started) state.torque_limit_nm[j] = torque_limit_nm;
    if (const auto back_rad = before_rise(j, torque_limit_nm, measured_rad[j], state)) {
      target_rad = *back_rad;
      torque_limit_nm = state.torque_limit_nm[j];
    }
    if (const double lead = lead_rad(joint, torque_limit_nm); std::isfinite(measured_rad[j]))
      target_rad = clamp_position(joint, std::clamp(target_rad, measured_rad[j] - lead, measured_rad[j] + lead));
    const double step_rad = speed_share_ * joint.max_speed_rad_s * dt_s;
    const double position_rad = std::clamp(target_rad, previous_rad - step_rad, previous_rad + step_rad);
    command.position_rad[j] = position_rad;
    command.velocity_rad_s[j] = (position_rad - previous_rad) / dt_s;
    command.torque_limit_nm[j] = state.torque_limit_nm[j] = torque_limit_nm;
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
    state.torque_limit_nm[j] = 0.0;
  }
  state.started = true;
  return command;
}

}  // namespace constrictor
