// The parameters of the relay: one row each. plant_relay.yaml and the table in README.md follow from the rows.
#pragma once

#include <cmath>
#include <cstdint>

#include "plant/plant_parameters.hpp"

namespace constrictor {

struct PlantRelayConfig : PlantParameters {
  double control_period_s = add(control_period_s, "period_s", 0.02, "s", {0.002, 0.2}, kAtStart, "Length of a tick");
  double patience_s = add(patience_s, "hardware.patience_s", 30.0, "s", {0.1, 3600.0}, kAtStart,
                          "Time to wait for the first measured posture; without it the run ends");
  int lost_after_ticks = add(lost_after_ticks, "hardware.lost_after_ticks", 5, "ticks", {1, 1000}, kAtStart,
                             "Without an acceptable joint state for so long, the hardware is lost: the robot holds");
  int unconfirmed_after_ticks = add(unconfirmed_after_ticks, "hardware.unconfirmed_after_ticks", 10, "ticks", {2, 1000},
                                    kAtStart, "If the hardware confirms no command of the last ticks, the robot holds");
  int frozen_after_ticks =
      add(frozen_after_ticks, "hardware.frozen_after_ticks", 25, "ticks", {5, 100000}, kAtStart,
          "If all measured angles stay the same for so long although a joint should move, an emergency stop follows");
  double frozen_error_rad = add(frozen_error_rad, "hardware.frozen_error_rad", 0.1, "rad", {0.001, 3.0}, kAtStart,
                                "Distance from its setpoint at which a joint should move");
  double limit_tolerance_rad = add(limit_tolerance_rad, "hardware.limit_tolerance_rad", 0.2, "rad", {0.0, 3.0},
                                   kAtStart, "A measured angle further than this beyond the joint's limits is refused");
  double jump_tolerance_rad =
      add(jump_tolerance_rad, "hardware.jump_tolerance_rad", 0.2, "rad", {0.01, 3.0}, kAtStart,
          "A measured angle is refused if it differs by more than this from what the joint's largest speed allows");
  bool torque_mode = add(torque_mode, "hardware.torque_mode", false,
                         "The hardware obeys kServoTorque; if false, commands that demand torques are refused");
  GateLimits command = add_gate_limits(command);

  [[nodiscard]] std::int64_t period_ns() const { return std::llround(control_period_s * 1e9); }
  [[nodiscard]] GateLimits gate_limits() const {
    return {command.stale_after_ticks, command.relax_after_ticks, torque_mode};
  }
  [[nodiscard]] std::int64_t patience_ticks() const { return std::llround(patience_s / control_period_s); }
};

}  // namespace constrictor
