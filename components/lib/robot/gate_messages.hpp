// The safety gate's inputs from messages: for control's output and for every plant (simulated, or a driver of servos).
#pragma once

#include <algorithm>
#include <span>

#include "constrictor/messages.hpp"
#include "robot/safety_gate.hpp"

namespace constrictor {

/// The command of a message. `header` names the step that wrote it. The result refers to the arrays of the message.
[[nodiscard]] inline GateCommand gate_command(const msg::JointCommand& command, const msg::Header& header) {
  const std::size_t count = std::min<std::size_t>(command.joint_count, msg::kMaxJoints);
  return {header.run_id,
          header.epoch,
          header.tick,
          header.sequence_number,
          command.mode,
          std::span(command.position_rad, count),
          std::span(command.velocity_rad_s, count),
          std::span(command.torque_limit_nm, count),
          std::span(command.torque_nm, count)};
}

/// The mode of the command that carries the gate's setpoints on.
[[nodiscard]] inline std::uint8_t servo_mode(const GateState& state) {
  if (state.mode == GateMode::kRelaxed) return msg::kServoRelaxed;
  return state.mode == GateMode::kObeying && state.torque ? msg::kServoTorque : msg::kServoFollow;
}

/// The order that the newest Authority message, which is `age_ticks` old, gives to the gate. Before the first message
/// (null) commands are obeyed.
[[nodiscard]] inline GateOrder gate_order(const msg::Authority* authority, std::int64_t age_ticks, GateState& state) {
  if (!authority) return GateOrder::kObey;
  return SafetyGate::order_of(authority->emergency_stop, level_in_force(authority->level, age_ticks), authority->source,
                              state);
}

}  // namespace constrictor
