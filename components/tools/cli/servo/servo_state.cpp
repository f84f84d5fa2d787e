// `constrictor servo scan` and `constrictor servo monitor`: what the devices at a serial port report.
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <thread>

#include "cli/servo/servo_options.hpp"
#include "cli/usage.hpp"
#include "common/interrupt.hpp"
#include "configuration/counted.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using dynamixel::kBaudRates;

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

/// The hardware errors of a servo, and its watchdog if that has tripped.
std::string errors_of(ServoAccess& access, const FoundServo& servo) {
  const auto errors = static_cast<std::uint8_t>(access.read(servo, "hardware_error_status"));
  const bool tripped = access.read(servo, "bus_watchdog") == dynamixel::kWatchdogTripped;
  return dynamixel::hardware_error_text(errors) + (tripped ? ", watchdog tripped" : "");
}

std::string line_of(ServoAccess& access, const FoundServo& device) {
  return fmt::format("position {}, {:.1f} V, {} C, torque {}, error: {}", access.read(device, "present_position"),
                     static_cast<double>(access.read(device, "present_input_voltage")) * device.model->voltage_unit_v,
                     access.read(device, "present_temperature"),
                     access.read(device, "torque_enable") != 0 ? "on" : "off", errors_of(access, device));
}

/// Returns whether every device has an id of its own, and can be read.
bool print_devices(ServoAccess& access, const std::vector<FoundServo>& found) {
  bool good = true;
  for (const FoundServo& device : found) {
    if (device.devices > 1) {
      fmt::print("  id {:3}  {}\n", device.id, two_devices(device.id));
      good = false;
      continue;
    }
    if (!device.model) {
      fmt::print("  id {:3}  {}\n", device.id, device.model_name());
      continue;
    }
    std::string line;
    try {
      line = line_of(access, device);
    } catch (const std::runtime_error& error) {
      line = fmt::format("unreadable: {}", error.what());
      good = false;
    }
    fmt::print("  id {:3}  {}, firmware {}, {}\n", device.id, device.model_name(), device.firmware, line);
  }
  return good;
}

void print_state(ServoAccess& access, const FoundServo& servo) {
  const auto steps = access.read(servo, "present_position");
  const double angle_rad = static_cast<double>(steps - 2048) * kTurn_rad / servo.model->steps_per_turn;
  fmt::print("{:>4} {:>9} {:>8.1f} {:>8.3f} {:>6.1f} {:>5} {:>4}  {}\n", servo.id, steps, angle_rad * 360.0 / kTurn_rad,
             static_cast<double>(access.read(servo, "present_current")) * servo.model->current_unit_a,
             static_cast<double>(access.read(servo, "present_input_voltage")) * servo.model->voltage_unit_v,
             access.read(servo, "present_temperature"), access.read(servo, "torque_enable"), errors_of(access, servo));
}

}  // namespace

void require_choice(const ServoOptions& options) {
  if (options.id.has_value() == options.all) throw UsageError("servo: found both or neither, accepted --id N or --all");
}

std::vector<FoundServo> chosen_servos(ServoAccess& access, const ServoOptions& options) {
  require_choice(options);
  if (options.id) return {access.find_single(static_cast<std::uint8_t>(*options.id))};
  return access.single_servos();
}

int scan_servos(const ServoOptions& options) {
  std::size_t count = 0;
  bool good = true;
  for (const std::uint32_t baud : kBaudRates) {
    if (!options.every_baud && baud != options.baud) continue;
    ServoAccess access(options.port, baud);
    const auto found = access.scan();
    std::size_t devices = 0;
    for (const FoundServo& one : found) devices += static_cast<std::size_t>(one.devices);
    count += devices;
    if (found.empty()) continue;
    fmt::print("{} at {} bit/s: {}\n", options.port, baud, counted(devices, "device"));
    good = print_devices(access, found) && good;
  }
  if (count > 0) return good ? exit_status::kOk : exit_status::kFailed;
  fmt::print(stderr, "servo scan: no servo answers at {} with {}. Is the power on, and the cable plugged in? {}\n",
             options.port, options.every_baud ? "any baud rate" : fmt::format("{} bit/s", options.baud),
             options.every_baud ? "Do two servos have the same id? Connect one at a time." : "Try --every-baud.");
  return exit_status::kFailed;
}

int monitor_servos(const ServoOptions& options) {
  ServoAccess access(options.port, options.baud);
  const std::vector<FoundServo> servos = chosen_servos(access, options);
  catch_interrupts();
  for (int round = 0; interrupt_signal() == 0 && (options.rounds == 0 || round < options.rounds); ++round) {
    if (round > 0) std::this_thread::sleep_for(std::chrono::milliseconds(500));
    fmt::print("{:>4} {:>9} {:>8} {:>8} {:>6} {:>5} {:>4}  error\n", "id", "steps", "degrees", "ampere", "V", "C",
               "on");
    for (const FoundServo& servo : servos) {
      try {
        print_state(access, servo);
      } catch (const std::runtime_error& error) {
        fmt::print("{:>4} unreadable: {}\n", servo.id, error.what());
      }
    }
    std::fflush(stdout);
  }
  return exit_status::kOk;
}

}  // namespace constrictor::cli
