// The part of JointServos that starts, unlocks and releases servos, one question after the other.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "servo_bus/joint_servos.hpp"

namespace constrictor {

using dynamixel::Bytes;
using dynamixel::Register;
using serial::Answer;
using serial::BusMaster;

namespace {

constexpr int kTries = 3;
constexpr double kStartSlack_s = 0.03;  // before the first tick there is time, and a busy computer may be late
constexpr std::int64_t kTimeBasedProfile = 1 << 2;  // bit of the register drive_mode; the direction stays normal

Answer write(BusMaster& bus, std::uint8_t id, const Register& reg, std::int64_t value) {
  Bytes bytes;
  dynamixel::put_value(bytes, reg, value);
  return bus.write(id, reg.address, bytes, kTries);
}

/// A servo cannot be started; the text says why.
class StartFailure : public std::runtime_error {
 public:
  StartFailure(const char* attempt, const Register& reg, const Answer& answer)
      : std::runtime_error(fmt::format("cannot {} {}: {}", attempt, reg.name, answer.text())),
        is_silent(!answer.arrived) {}
  const bool is_silent;
};

/// The value of a register. Throws StartFailure.
std::int64_t read(BusMaster& bus, std::uint8_t id, const Register& reg) {
  const Answer answer = bus.read(id, reg.address, reg.bytes, kTries);
  if (!answer.good()) throw StartFailure("read", reg, answer);
  return dynamixel::get_number(answer.data, reg.bytes, reg.is_signed);
}

void require(const Answer& answer, const Register& reg) {
  if (!answer.good()) throw StartFailure("write", reg, answer);
}

}  // namespace

void JointServos::configure(BusMaster& bus, const Joint& joint, bool tripped) {
  const dynamixel::ServoModel& model = plan_.model;
  const std::uint8_t id = joint.servo.id;
  const std::pair<const char*, std::int64_t> wanted[] = {
      {"return_delay_time", 0},
      {"drive_mode", kTimeBasedProfile},
      {"operating_mode", static_cast<std::int64_t>(dynamixel::OperatingMode::kCurrentBasedPosition)},
      {"homing_offset", 0}};
  bool off = read(bus, id, model.at("torque_enable")) == 0;
  for (const auto& [name, value] : wanted) {
    const Register& reg = model.at(name);
    // A locked servo keeps its torque until an operator has cleared the stop. The EEPROM wears out by writing.
    if (tripped || read(bus, id, reg) == value) continue;
    if (!off) require(write(bus, id, model.at("torque_enable"), 0), model.at("torque_enable"));
    off = true;
    require(write(bus, id, reg, value), reg);
  }
  require(bus.write(id, model.at("indirect_address_1").address, pointers_, kTries), model.at("indirect_address_1"));
  require(write(bus, id, model.at("profile_acceleration"), 0), model.at("profile_acceleration"));
  require(write(bus, id, model.at("profile_velocity"), config_.profile_ms()), model.at("profile_velocity"));
}

JointServos::StartProblem JointServos::bring_up(BusMaster& bus, Joint& joint) {
  const dynamixel::ServoModel& model = plan_.model;
  const std::uint8_t id = joint.servo.id;
  try {
    const Answer found = bus.ping(id, kTries);
    if (!found.good() || found.data.size() < 2) return {"does not answer (power, cable, id, baud rate?)", true};
    const auto number = dynamixel::get_number(found.data, 2, false);
    if (number != model.number)
      return {fmt::format("is of model {}, accepted {} ({}): another device has this id", number, model.number,
                          model.name)};
    joint.firmware = found.data.size() > 2 ? found.data[2] : 0;
    slow_[joint.servo.port] = !slow_because(joint.servo.port).empty();
    write(bus, id, model.at("status_return_level"), 2);  // without it there may be no answer to this very write
    const bool tripped = read(bus, id, model.at("bus_watchdog")) == dynamixel::kWatchdogTripped;
    configure(bus, joint, tripped);
    const double bearable_a = config_.load_share * model.stall_current_a;
    joint.current_limit = std::min(read(bus, id, model.at("current_limit")),
                                   static_cast<std::int64_t>(bearable_a / model.current_unit_a));
    const std::int64_t position = read(bus, id, model.at("present_position"));
    const double angle_rad = joint.servo.angle_rad(model, position);
    if (angle_rad < joint.limits.min_rad - config_.start_tolerance_rad ||
        angle_rad > joint.limits.max_rad + config_.start_tolerance_rad)
      return {
          fmt::format("measures {:.2f} rad, accepted {} to {} rad: move the joint by hand, or correct zero_steps and "
                      "direction in the bus file",
                      angle_rad, joint.limits.min_rad, joint.limits.max_rad)};
    if (!tripped) {
      require(write(bus, id, model.at("goal_position"), position), model.at("goal_position"));
      require(write(bus, id, model.at("bus_watchdog"), config_.watchdog_units()), model.at("bus_watchdog"));
    }
    const Answer block = bus.read(id, state_block_, state_bytes_, kTries);
    take(joint, block);
    if (!block.good() || joint.reading.voltage_v <= 0.0)
      return {"does not keep its indirect addresses", !block.arrived};
  } catch (const StartFailure& failure) {
    return {failure.what(), failure.is_silent};
  }
  joint.state = ServoState::kReady;
  joint.misses = 0;
  return {};
}

std::string JointServos::slow_because(std::size_t port) const {
  if (plan_.fast_sync_read) return *plan_.fast_sync_read ? "" : "fast_sync_read is false in the bus file";
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const Joint& joint = joints_[i];
    if (joint.servo.port == port && joint.firmware != 0 && joint.firmware < plan_.model.fast_sync_read_from)
      return fmt::format("{} has firmware {}, and Fast Sync Read needs {}", name_of(i), joint.firmware,
                         plan_.model.fast_sync_read_from);
  }
  return {};
}

std::vector<std::string> JointServos::start(double patience_s) {
  for (std::size_t port = 0; port < ports_.size(); ++port)
    ports_.with(port, news_, [](BusMaster& bus) { bus.set_slack(kStartSlack_s); });
  const std::int64_t until_ns = ports_.now_ns() + std::llround(patience_s * 1e9);
  std::vector<std::size_t> waiting(joints_.size());
  std::iota(waiting.begin(), waiting.end(), std::size_t{0});
  std::map<std::size_t, std::string> failed;
  do {
    for (const std::size_t i : std::exchange(waiting, {})) {
      Joint& joint = joints_[i];
      StartProblem problem{"its port is closed"};
      ports_.with(joint.servo.port, news_, [&](BusMaster& bus) { problem = bring_up(bus, joint); });
      failed.erase(i);
      if (!problem.why.empty()) failed[i] = std::move(problem.why);
      if (problem.is_silent) waiting.push_back(i);
    }
  } while (!waiting.empty() && ports_.now_ns() < until_ns);
  for (std::size_t port = 0; port < ports_.size(); ++port)
    ports_.with(port, news_, [&](BusMaster& bus) {
      bus.set_return_delay(0.0);
      bus.set_slack(config_.answer_slack_s);
    });
  std::vector<std::string> lines;
  for (const auto& [joint, why] : failed) lines.push_back(fmt::format("{}: {}", name_of(joint), why));
  return lines;
}

void JointServos::unlock() {
  const dynamixel::ServoModel& model = plan_.model;
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    if (joint.state == ServoState::kLost || joint.reading.watchdog != dynamixel::kWatchdogTripped) continue;
    ports_.with(joint.servo.port, news_, [&](BusMaster& bus) {
      // First 0, which clears it. A servo that was found locked at the start was not configured then.
      const bool cleared = write(bus, joint.servo.id, model.at("bus_watchdog"), 0).good();
      if (const std::string why = cleared ? bring_up(bus, joint).why : "its watchdog cannot be cleared"; !why.empty())
        lose(i, why);
    });
  }
}

std::vector<std::size_t> JointServos::clear(const Register& reg, std::vector<std::size_t> joints) {
  const Bytes zeros(reg.bytes, 0);
  for (int i = 0; i < kTries && !joints.empty(); ++i) {
    std::vector<Bytes> ids(ports_.size());
    for (const std::size_t joint : joints) ids[joints_[joint].servo.port].push_back(joints_[joint].servo.id);
    // No servo waits until those at another port have confirmed.
    for (std::size_t port = 0; port < ports_.size(); ++port) {
      if (ids[port].empty()) continue;
      Bytes data;
      for (std::size_t k = 0; k < ids[port].size(); ++k) data.insert(data.end(), zeros.begin(), zeros.end());
      ports_.with(port, news_, [&](BusMaster& bus) { bus.sync_write(reg.address, reg.bytes, ids[port], data); });
    }
    for (std::size_t port = 0; port < ports_.size(); ++port) {
      ports_.with(port, news_, [&](BusMaster& bus) {
        const auto use = [&](std::uint8_t id, const Answer& answer) {
          if (!answer.good() || answer.data != zeros) return;
          std::erase_if(joints, [&](std::size_t joint) {
            return joints_[joint].servo.port == port && joints_[joint].servo.id == id;
          });
        };
        // In an answer to Sync Read, the servos behind a silent one are silent, too. At last each is asked by itself.
        if (i + 1 < kTries) bus.sync_read(reg.address, reg.bytes, ids[port], use);
        else
          for (const std::uint8_t id : ids[port]) use(id, bus.read(id, reg.address, reg.bytes, 1));
      });
    }
  }
  return joints;
}

std::vector<std::string> JointServos::release(bool torque_off) {
  std::vector<std::string> failed;
  std::vector<std::size_t> all(joints_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  if (torque_off) {
    for (const std::size_t joint : clear(plan_.model.at("torque_enable"), all))
      failed.push_back(
          fmt::format("{} has not confirmed that its torque is off: switch its power off", name_of(joint)));
  } else {
    std::erase_if(all,
                  [&](std::size_t joint) { return joints_[joint].reading.watchdog == dynamixel::kWatchdogTripped; });
  }
  for (const std::size_t joint : clear(plan_.model.at("bus_watchdog"), all))
    failed.push_back(fmt::format("{} has not confirmed that its watchdog is off", name_of(joint)));
  return failed;
}

}  // namespace constrictor
