#include "robot/safety_gate.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string_view>
#include <utility>

#include "constrictor/messages.hpp"

namespace constrictor {
namespace {

constexpr double kRounding_rad = 1e-9;

bool finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

double finite_or(double value, double otherwise) { return std::isfinite(value) ? value : otherwise; }

JointSetpoint setpoint_of(const GateCommand& command, std::size_t joint) {
  const double limit_nm = command.torque_limit_nm[joint];
  if (command.mode == msg::kServoTorque)
    return {command.position_rad[joint], 0.0, limit_nm, command.torque_nm[joint], true};
  return {command.position_rad[joint], command.velocity_rad_s[joint], limit_nm};
}

}  // namespace

const char* text_of(GateRefusal refusal) {
  static constexpr std::array<const char*, static_cast<std::size_t>(GateRefusal::kCount)> kTexts = {
      "accepted",
      "of another epoch",
      "from the future",
      "stale on arrival",
      "unknown mode",
      "wrong number of joints",
      "not finite",
      "beyond a joint's limits",
      "torques demanded of a plant that has no torque mode"};
  return kTexts.at(static_cast<std::size_t>(refusal));
}

std::uint64_t refused_count(const GateState& state) {
  return std::accumulate(state.refused.begin(), state.refused.end(), std::uint64_t{0});
}

std::string text_of(GateRefusal refusal, const GateState& state) {
  return std::string(text_of(refusal)) + " (" + std::to_string(SafetyGate::refused(state, refusal)) + " so far)";
}

SafetyGate::SafetyGate(const RobotModel& robot, GateLimits limits) : joints_(robot.joints), limits_(limits) {}

GateRefusal SafetyGate::judge(const GateCommand& command, const GateInstant& now) const {
  if (command.run_id != now.run_id || command.epoch != now.epoch) return GateRefusal::kWrongEpoch;
  if (command.tick > now.tick) return GateRefusal::kFromFuture;
  if (now.tick - command.tick > limits_.stale_after_ticks) return GateRefusal::kStale;
  const bool torque = command.mode == msg::kServoTorque;
  if (command.mode != msg::kServoFollow && command.mode != msg::kServoRelaxed && !torque)
    return GateRefusal::kUnknownMode;
  if (torque && !limits_.torque_mode) return GateRefusal::kNoTorqueMode;
  const std::size_t count = joints_.size();
  if (command.position_rad.size() != count || command.velocity_rad_s.size() != count ||
      command.torque_limit_nm.size() != count || (torque && command.torque_nm.size() != count)) {
    return GateRefusal::kWrongCount;
  }
  if (!finite(command.position_rad) || !finite(command.velocity_rad_s) || !finite(command.torque_limit_nm) ||
      (torque && !finite(command.torque_nm))) {
    return GateRefusal::kNotFinite;
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_acceptable(joints_[i], setpoint_of(command, i))) return GateRefusal::kBeyondLimits;
  }
  return GateRefusal::kNone;
}

GateRefusal SafetyGate::offer(const GateCommand& command, const GateInstant& now, GateState& state) const {
  const GateRefusal refusal = judge(command, now);
  const bool new_message = command.sequence_number != state.last_sequence;
  state.last_sequence = command.sequence_number;
  if (refusal != GateRefusal::kNone) {
    if (new_message) ++state.refused[static_cast<std::size_t>(refusal)];
    return refusal;
  }
  state.offered.resize(joints_.size());
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    state.offered[i] = clamp_to_limits(joints_[i], setpoint_of(command, i));
  }
  state.relax = command.mode == msg::kServoRelaxed;
  state.torque = command.mode == msg::kServoTorque;
  state.accepted = true;
  return GateRefusal::kNone;
}

GateOrder SafetyGate::order_of(bool emergency_stop, std::uint8_t level, std::span<const char> source,
                               GateState& state) {
  if (emergency_stop || level == 0) {
    state.level = 0;
    state.source.clear();
    if (emergency_stop) return GateOrder::kStop;
    return state.commanded ? GateOrder::kHold : GateOrder::kObey;
  }
  const std::string_view name(source.data(), ::strnlen(source.data(), source.size()));
  if (level != state.level || name != state.source) {
    state.take_over = state.commanded;
    state.commanded = true;
    state.level = level;
    state.source = name;
  }
  return GateOrder::kObey;
}

const std::vector<JointSetpoint>& SafetyGate::setpoints(const MeasuredJoints& measured, GateOrder order, double dt_s,
                                                        GateState& state) const {
  const std::span<const double> measured_rad = measured.angle_rad;
  if (!state.started) {
    state.started = true;
    state.setpoints.resize(joints_.size());
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      state.setpoints[i] =
          clamp_to_limits(joints_[i], {finite_or(measured_rad[i], 0.0), 0.0, joints_[i].max_torque_nm});
    }
  }
  const bool accepted = std::exchange(state.accepted, false);
  state.silent_ticks = accepted ? 0 : state.silent_ticks + 1;
  const GateMode before = state.mode;
  if (order == GateOrder::kStop) {
    state.mode = GateMode::kStopped;
  } else if (accepted && order == GateOrder::kObey) {
    state.mode = state.relax ? GateMode::kRelaxed : GateMode::kObeying;
  } else {
    state.mode = state.silent_ticks > limits_.relax_after_ticks ? GateMode::kRelaxed : GateMode::kHolding;
  }
  const bool held = before == GateMode::kHolding || before == GateMode::kStopped;
  if (state.mode == GateMode::kObeying && state.torque) {
    exert(measured, dt_s, state);
  } else if (state.mode == GateMode::kObeying) {
    follow(measured_rad, dt_s, state);
  } else if (state.mode == GateMode::kRelaxed) {
    relax(measured_rad, state);
  } else if (!held) {
    hold(measured_rad, state);  // only once: a joint that sags under load must not move the setpoint
  }
  return state.setpoints;
}

void SafetyGate::follow(std::span<const double> measured_rad, double dt_s, GateState& state) const {
  const bool take_over = std::exchange(state.take_over, false);
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double step_rad = joints_[i].max_speed_rad_s * dt_s + kRounding_rad;
    double before_rad = state.setpoints[i].position_rad;
    // A loaded joint is not at its setpoint, and after torque mode it has none. The motion begins where the joint is.
    if (take_over || state.setpoints[i].torque_mode)
      before_rad = clamp_position(joints_[i], finite_or(measured_rad[i], before_rad));
    state.setpoints[i] = state.offered[i];
    state.setpoints[i].position_rad =
        std::clamp(state.offered[i].position_rad, before_rad - step_rad, before_rad + step_rad);
  }
}

void SafetyGate::exert(const MeasuredJoints& measured, double dt_s, GateState& state) const {
  state.take_over = false;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const double angle_rad = measured.angle_rad[i];
    const double rate_rad_s = measured.rate_rad_s.empty() ? std::nan("") : measured.rate_rad_s[i];
    const double torque_nm = safe_torque_nm(joints_[i], state.offered[i].torque_nm, angle_rad, rate_rad_s, dt_s);
    const double position_rad = clamp_position(joints_[i], finite_or(angle_rad, state.setpoints[i].position_rad));
    state.setpoints[i] = {position_rad, 0.0, state.offered[i].torque_limit_nm, torque_nm, true};
  }
}

void SafetyGate::hold(std::span<const double> measured_rad, GateState& state) const {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    JointSetpoint& setpoint = state.setpoints[i];
    const double angle_rad = finite_or(measured_rad[i], setpoint.position_rad);
    if (setpoint.torque_mode || std::abs(setpoint.position_rad - angle_rad) >= kAgreement_rad)
      setpoint.position_rad = angle_rad;
    setpoint.torque_mode = false;
    setpoint.torque_nm = 0.0;
    if (setpoint.torque_limit_nm <= 0.0) setpoint.torque_limit_nm = joints_[i].max_torque_nm;
    setpoint.velocity_rad_s = 0.0;
    setpoint = clamp_to_limits(joints_[i], setpoint);
  }
}

void SafetyGate::relax(std::span<const double> measured_rad, GateState& state) const {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    state.setpoints[i] =
        clamp_to_limits(joints_[i], {finite_or(measured_rad[i], state.setpoints[i].position_rad), 0.0, 0.0});
  }
}

}  // namespace constrictor
