// `constrictor servo`: commissioning of the servos at a serial port. No run may use the port meanwhile.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include "cli/servo/servo_options.hpp"
#include "cli/subcommands.hpp"
#include "cli/usage.hpp"
#include "runtime/host.hpp"

namespace constrictor::cli {
namespace {

using dynamixel::kBaudRates;

/// The servo of `id` and `baud`. Throws if it does not answer, shares its id, or its EEPROM is locked.
FoundServo unlocked_servo(ServoAccess& access, const ServoOptions& options) {
  const FoundServo servo = access.find_single(static_cast<std::uint8_t>(*options.id));
  if (access.read(servo, "torque_enable") == 0) return servo;
  throw std::runtime_error(
      fmt::format("servo {}: its torque is on, and its EEPROM is locked; first: constrictor servo "
                  "torque off --port {} --baud {} --id {}",
                  servo.id, options.port, options.baud, servo.id));
}

int change_id(const ServoOptions& options) {
  ServoAccess access(options.port, options.baud);
  const auto to = static_cast<std::uint8_t>(options.to);
  if (to != *options.id && access.answers(to))
    throw std::runtime_error(fmt::format(
        "--to: found {}, which another device at {} has; accepted an id that no device has", to, options.port));
  const FoundServo servo = unlocked_servo(access, options);
  access.write(servo, "id", to);
  if (!access.answers(to) || (to != servo.id && access.answers(servo.id)))
    throw std::runtime_error(
        fmt::format("servo {}: its id was written, but the servo does not answer as {}: scan the "
                    "port again",
                    servo.id, to));
  fmt::print("servo {} is now servo {}\n", servo.id, to);
  return exit_status::kOk;
}

int change_baud(const ServoOptions& options) {
  const auto rate = std::find(std::begin(kBaudRates), std::end(kBaudRates), options.to_baud);
  {
    ServoAccess access(options.port, options.baud);
    access.write(unlocked_servo(access, options), "baud_rate", rate - std::begin(kBaudRates));
  }
  if (!ServoAccess(options.port, options.to_baud).answers(static_cast<std::uint8_t>(*options.id)))
    throw std::runtime_error(
        fmt::format("servo {}: its baud rate was written, but it does not answer at {} bit/s: try "
                    "`constrictor servo scan --port {} --every-baud`",
                    *options.id, options.to_baud, options.port));
  fmt::print("servo {} now has {} bit/s\n", *options.id, options.to_baud);
  return exit_status::kOk;
}

/// A value that is to be written to a register of a servo.
struct Change {
  FoundServo servo;
  const char* name;
  std::int64_t units;
};

int limits(const ServoOptions& options) {
  ServoAccess access(options.port, options.baud);
  const std::vector<FoundServo> servos = chosen_servos(access, options);
  // All values of all servos are checked before the first one is written.
  std::vector<Change> changes;
  for (const FoundServo& servo : servos) {
    const auto set = [&](const char* option, const char* name, double value, double unit, const char* symbol) {
      const auto& reg = servo.model->at(name);
      const double units = std::round(value / unit);
      if (!(units >= static_cast<double>(reg.min) && units <= static_cast<double>(reg.max)))
        throw UsageError(fmt::format("servo limits: {} (register {}): found {:g} {}, accepted {:g} to {:g} {}", option,
                                     name, value, symbol, static_cast<double>(reg.min) * unit,
                                     static_cast<double>(reg.max) * unit, symbol));
      changes.push_back({servo, name, std::llround(units)});
    };
    if (options.current_a) set("--current", "current_limit", *options.current_a, servo.model->current_unit_a, "A");
    if (options.temperature_c) set("--temperature", "temperature_limit", *options.temperature_c, 1.0, "C");
    if (!changes.empty() && access.read(servo, "torque_enable") != 0)
      throw std::runtime_error(
          fmt::format("servo {}: its torque is on, and its EEPROM is locked; first switch it off", servo.id));
  }
  for (const auto& [servo, name, units] : changes) access.write(servo, name, units);
  for (const FoundServo& servo : servos)
    fmt::print("servo {}: current {:.2f} A, temperature {} C, velocity {:.2f} rad/s, position {} to {} steps\n",
               servo.id, static_cast<double>(access.read(servo, "current_limit")) * servo.model->current_unit_a,
               access.read(servo, "temperature_limit"),
               static_cast<double>(access.read(servo, "velocity_limit")) * servo.model->velocity_unit_rad_s,
               access.read(servo, "min_position_limit"), access.read(servo, "max_position_limit"));
  return exit_status::kOk;
}

int zero(const ServoOptions& options) {
  ServoAccess access(options.port, options.baud);
  fmt::print("# For the bus file, if each joint is at its angle 0 now:\njoints:\n");
  for (const FoundServo& servo : chosen_servos(access, options)) {
    if (access.read(servo, "torque_enable") != 0)
      throw std::runtime_error(
          fmt::format("servo {}: its torque is on: switch it off and lay the joint straight by hand", servo.id));
    fmt::print("  - {{id: {}, zero_steps: {}}}\n", servo.id, access.read(servo, "present_position"));
  }
  return exit_status::kOk;
}

CLI::Validator known_baud() {
  std::vector<std::string> rates;
  for (const auto rate : kBaudRates) rates.push_back(std::to_string(rate));
  return one_of(rates);
}

CLI::App* add(CLI::App& group, const std::string& name, const std::string& what, Action& action, bool one_or_all,
              const std::shared_ptr<ServoOptions>& options, int (*run)(const ServoOptions&)) {
  CLI::App* sub = add_subcommand(group, name, what, action, options, run);
  sub->add_option("--port", options->port, "serial port, for example /dev/ttyUSB0")->required();
  sub->add_option("--baud", options->baud, "[bit/s] baud rate of the servos")
      ->capture_default_str()
      ->check(known_baud());
  if (!one_or_all) return sub;
  sub->add_option("--id", options->id, "id of one servo")->check(whole_number(0, 252));
  sub->add_flag("--all", options->all, "all servos at the port");
  return sub;
}

}  // namespace

void add_servo(CLI::App& app, Action& action) {
  auto options = std::make_shared<ServoOptions>();
  CLI::App* group = add_group(app, "servo", "commission the servos at a serial port");
  CLI::App* scan = add(*group, "scan", "list the devices that answer", action, false, options, scan_servos);
  scan->add_flag("--every-baud", options->every_baud, "try every baud rate (6 s)");
  CLI::App* id = add(*group, "id", "give a servo another id", action, false, options, change_id);
  id->add_option("--id", options->id, "present id")->required()->check(whole_number(0, 252));
  id->add_option("--to", options->to, "new id")->required()->check(whole_number(0, 252));
  CLI::App* baud = add(*group, "baud", "give a servo another baud rate", action, false, options, change_baud);
  baud->add_option("--id", options->id, "id of the servo")->required()->check(whole_number(0, 252));
  baud->add_option("--to", options->to_baud, "[bit/s] new baud rate")->required()->check(known_baud());
  CLI::App* limit = add(*group, "limits", "show the limits of servos, and set them", action, true, options, limits);
  limit->add_option("--current", options->current_a, "[A] limit of the current, and so of the torque");
  limit->add_option("--temperature", options->temperature_c, "[C] temperature at which the servo shuts down");
  CLI::App* at_zero =
      add(*group, "zero", "print the present positions as zero_steps for the bus file", action, true, options, zero);
  CLI::App* on_off = add(*group, "torque", "switch the torque on (the servo stays where it is) or off", action, true,
                         options, switch_torque);
  on_off->add_option("STATE", options->state, "on or off")->required()->check(one_of({"on", "off"}));
  CLI::App* monitor = add(*group, "monitor", "show position, current, voltage and temperature twice a second", action,
                          true, options, monitor_servos);
  monitor->add_option("--rounds", options->rounds, "how often; 0: until Ctrl+C")->check(whole_number(0, 1'000'000));
  const auto footer = [](std::initializer_list<const char*> examples) {
    return help_footer(
        "The port is used by one program at a time: end the run that uses it first. A servo whose torque is on has a\n"
        "locked EEPROM (id, limits). `torque off` also clears a tripped watchdog.",
        examples,
        "0 done; 1 no servo answers, one cannot be read, or two have one id; 64 wrong usage; 70 the port or a servo\n"
        "  refuses, with the reason",
        kDataEnvironment);
  };
  constexpr const char* kScan = "constrictor servo scan --port /dev/ttyUSB0 --every-baud";
  constexpr const char* kId = "constrictor servo id --port /dev/ttyUSB0 --id 1 --to 7";
  constexpr const char* kTorque = "constrictor servo torque off --port /dev/ttyUSB0 --all";
  constexpr const char* kMonitor = "constrictor servo monitor --port /dev/ttyUSB0 --all";
  group->footer(footer({kScan, kId, kTorque, kMonitor}));
  scan->footer(footer({kScan}));
  id->footer(footer({kId}));
  baud->footer(footer({"constrictor servo baud --port /dev/ttyUSB0 --id 7 --to 1000000"}));
  limit->footer(footer({"constrictor servo limits --port /dev/ttyUSB0 --all",
                        "constrictor servo limits --port /dev/ttyUSB0 --id 7 --current 2 --temperature 70"}));
  at_zero->footer(footer({"constrictor servo zero --port /dev/ttyUSB0 --all"}));
  on_off->footer(footer({kTorque}));
  monitor->footer(footer({kMonitor}));
}

}  // namespace constrictor::cli
