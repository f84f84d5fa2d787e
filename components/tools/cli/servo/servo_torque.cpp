// `constrictor servo torque`.
#include <fmt/format.h>

#include <stdexcept>

#include "cli/servo/servo_options.hpp"
#include "cli/usage.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

/// Throws std::runtime_error if the servo does not confirm it.
void switch_off(ServoAccess& access, const FoundServo& servo) {
  access.write(servo, "torque_enable", 0);
  if (access.read(servo, "torque_enable") != 0)
    throw std::runtime_error(fmt::format("servo {}: its torque is still on", servo.id));
  access.write(servo, "bus_watchdog", 0);
}

int off(ServoAccess& access, const ServoOptions& options) {
  // Before any question: no servo that is silent, or that has an error, keeps the others under torque.
  const auto id = options.id ? std::optional(static_cast<std::uint8_t>(*options.id)) : std::nullopt;
  access.order_torque_off(id);
  std::vector<FoundServo> servos;
  if (id) servos = {access.find(*id)};
  else servos = access.scan();
  std::erase_if(servos, [](const FoundServo& one) { return one.model == nullptr; });
  if (servos.empty())
    throw std::runtime_error(
        fmt::format("no servo answers at {}; the order to switch the torque off was sent to all servos", options.port));
  std::vector<std::string> failed;
  for (const FoundServo& servo : servos) {
    try {
      switch_off(access, servo);
      fmt::print("servo {}: torque off\n", servo.id);
    } catch (const std::runtime_error& error) {
      failed.emplace_back(error.what());
    }
  }
  if (failed.empty()) return exit_status::kOk;
  fmt::print(stderr,
             "servo torque: {} of {} servos have not confirmed that their torque is off; repeat the command, or switch "
             "the power off:\n  {}\n",
             failed.size(), servos.size(), fmt::join(failed, "\n  "));
  return exit_status::kSoftware;
}

}  // namespace

int switch_torque(const ServoOptions& options) {
  require_choice(options);
  ServoAccess access(options.port, options.baud);
  if (options.state == "off") return off(access, options);
  for (const FoundServo& servo : chosen_servos(access, options)) {
    const auto errors = static_cast<std::uint8_t>(access.read(servo, "hardware_error_status"));
    if (access.read(servo, "torque_enable") == 0) {
      if ((errors & access.read(servo, "shutdown")) != 0)
        throw std::runtime_error(
            fmt::format("servo {}: it has shut down with {}: let it cool down, remove the load, and "
                        "switch its power off and on",
                        servo.id, dynamixel::hardware_error_text(errors)));
      access.write(servo, "bus_watchdog", 0);
      // It must not jump to an old goal.
      access.write(servo, "goal_position", access.read(servo, "present_position"));
      access.write(servo, "torque_enable", 1);
    }
    fmt::print("servo {}: torque on\n", servo.id);
  }
  return exit_status::kOk;
}

}  // namespace constrictor::cli
