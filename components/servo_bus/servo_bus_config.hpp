// The parameters of the driver: one row each. servo_bus.yaml and the table in README.md follow from the rows.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>

#include "plant/plant_parameters.hpp"

namespace constrictor {

struct ServoBusConfig : PlantParameters {
  double control_period_s = add(control_period_s, "period_s", 0.02, "s", {0.002, 0.2}, kAtStart, "Length of a tick");
  std::string bus_file = add(bus_file, "bus_file", "deploy/buses/mamba_emulated.yaml", {},
                             "Bus file: which servo moves which joint (components/lib/dynamixel/README.md)");
  double port_patience_s = add(port_patience_s, "port.patience_s", 10.0, "s", {0.0, 600.0}, kAtStart,
                               "Time to wait for the serial ports to appear at the start");
  double answer_slack_s =
      add(answer_slack_s, "port.answer_slack_s", 0.012, "s", {0.0002, 0.1}, kAtStart,
          "Time for adapter and operating system that an answer may take in addition to that of its bytes");
  double servo_patience_s = add(servo_patience_s, "servo.patience_s", 2.0, "s", {0.0, 60.0}, kAtStart,
                                "Time for which servos that are silent at the start are asked again");
  double watchdog_s = add(watchdog_s, "servo.watchdog_s", 0.1, "s", {0.04, 2.54}, kAtStart,
                          "Silence on the bus after which the servos stop and lock their goals; whole steps of 0.02 s");
  int lost_after_ticks = add(lost_after_ticks, "servo.lost_after_ticks", 3, "ticks", {1, 1000}, kAtStart,
                             "A servo that does not answer for so long is lost: the robot holds its posture");
  bool reboot_on_error = add(reboot_on_error, "servo.reboot_on_error", false,
                             "Start a servo anew that has shut down with a hardware error, at most three times");
  double stuck_after_s = add(stuck_after_s, "servo.stuck_after_s", 1.0, "s", {0.0, 60.0}, kAtStart,
                             "A joint that stands still for so long while its goal moves is named; 0: never");
  double load_share =
      add(load_share, "servo.load_share", 0.75, "", {0.05, 1.0}, kAtStart,
          "Largest share of the stall current that is asked for: a servo shuts down when it bears more for long");
  double start_tolerance_rad =
      add(start_tolerance_rad, "servo.start_tolerance_rad", 0.2, "rad", {0.0, 3.0}, kAtStart,
          "The robot does not start if a joint is further than this beyond its limits: its zero or direction is wrong");
  bool torque_off_at_exit = add(torque_off_at_exit, "servo.torque_off_at_exit", true,
                                "Switch the torque of all servos off when the process ends in order");
  GateLimits command = add_gate_limits(command);

  [[nodiscard]] std::int64_t period_ns() const { return std::llround(control_period_s * 1e9); }
  /// The time in which a servo moves to its goal: one tick. [ms]
  [[nodiscard]] std::int64_t profile_ms() const { return std::max(1L, std::lround(control_period_s * 1e3)); }
  [[nodiscard]] int stuck_ticks() const { return static_cast<int>(std::lround(stuck_after_s / control_period_s)); }
  [[nodiscard]] std::int64_t watchdog_units() const { return std::lround(watchdog_s / 0.02); }

  void complete(const Configuration& root) const {
    if (watchdog_s < 2.0 * control_period_s)
      throw root.error("servo.watchdog_s",
                       "found less than two ticks, accepted two ticks or more: a late tick would "
                       "stop the servos");
  }
};

}  // namespace constrictor
