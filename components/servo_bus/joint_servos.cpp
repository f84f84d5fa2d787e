#include "servo_bus/joint_servos.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace constrictor {

using dynamixel::Bytes;
using dynamixel::ByteView;

namespace {

constexpr int kRepetitions = 2;  // of the reading in a tick, for servos that did not answer
constexpr int kMostReboots = 3;
constexpr double kSearchSlack_s = 0.004;  // in each tick, to ask the lost servos again

/// The numbers that the block of measurements consists of, in its order.
constexpr std::pair<const char*, std::size_t> kStateRegisters[] = {
    {"present_current", 2},     {"present_velocity", 4},      {"present_position", 4}, {"hardware_error_status", 1},
    {"present_temperature", 1}, {"present_input_voltage", 2}, {"torque_enable", 1},    {"bus_watchdog", 1}};
/// The profile comes before the position that it applies to.
constexpr std::pair<const char*, std::size_t> kGoalRegisters[] = {
    {"goal_current", 2}, {"profile_velocity", 4}, {"goal_position", 4}};

}  // namespace

JointServos::JointServos(const dynamixel::BusPlan& plan, const RobotModel& robot, const ServoBusConfig& config,
                         BusPorts& ports)
    : plan_(plan),
      config_(config),
      ports_(ports),
      joints_(plan.joints.size()),
      slow_(ports.size()),
      reversed_(ports.size()) {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    joints_[i].limits = robot.joints.at(i);
    joints_[i].servo = plan.joints[i];
  }
  make_blocks();
}

void JointServos::make_blocks() {
  const auto begin = plan_.model.at("indirect_data_1").address;
  const auto append = [&](auto& registers) {
    std::uint16_t bytes = 0;
    for (const auto& [name, count] : registers) {
      const auto address = plan_.model.at(name).address;
      for (std::size_t i = 0; i < count; ++i)
        dynamixel::put_number(pointers_, static_cast<std::int64_t>(address + i), 2);
      bytes = static_cast<std::uint16_t>(bytes + count);
    }
    return bytes;
  };
  state_block_ = begin;
  state_bytes_ = append(kStateRegisters);
  goal_block_ = static_cast<std::uint16_t>(begin + state_bytes_);
  goal_bytes_ = append(kGoalRegisters);
}

std::string JointServos::name_of(std::size_t joint) const {
  const auto& servo = joints_[joint].servo;
  return fmt::format("servo {} of joint {} at {}", servo.id, joint, plan_.ports[servo.port].device);
}

Bytes JointServos::ids_at(std::size_t port, ServoState state, bool unseen_only) const {
  Bytes ids;
  for (const Joint& joint : joints_) {
    const bool wanted = state == ServoState::kLost ? joint.state == state : joint.state != ServoState::kLost;
    if (joint.servo.port == port && wanted && !(unseen_only && joint.seen)) ids.push_back(joint.servo.id);
  }
  return ids;
}

void JointServos::take(Joint& joint, const serial::Answer& answer) {
  if (!answer.good()) return;
  const dynamixel::ServoModel& model = plan_.model;
  std::size_t at = 0;
  const auto number = [&](std::size_t bytes, bool is_signed) {
    at += bytes;
    return dynamixel::get_number(ByteView(answer.data).subspan(at - bytes), bytes, is_signed);
  };
  JointReading reading;
  reading.torque_nm = joint.servo.torque_nm(model, number(2, true));
  reading.rate_rad_s = joint.servo.rate_rad_s(model, number(4, true));
  reading.angle_rad = joint.servo.angle_rad(model, number(4, true));
  reading.hardware_errors = static_cast<std::uint8_t>(number(1, false));
  reading.temperature_c = static_cast<int>(number(1, false));
  reading.voltage_v = static_cast<double>(number(2, false)) * model.voltage_unit_v;
  reading.torque_on = number(1, false) != 0;
  reading.watchdog = number(1, true);
  joint.seen = true;
  joint.misses = 0;
  // A servo that was started anew has forgotten which registers the block consists of, and reports no voltage.
  if (reading.voltage_v <= 0.0) {
    joint.reading.voltage_v = 0.0;
    return;
  }
  joint.reading = reading;
}

void JointServos::read_port(std::size_t port) {
  const auto use = [&](std::uint8_t id, const serial::Answer& answer) {
    for (Joint& joint : joints_) {
      if (joint.servo.port == port && joint.servo.id == id) take(joint, answer);
    }
  };
  const std::int64_t begin_ns = ports_.now_ns();
  ports_.with(port, news_, [&](serial::BusMaster& bus) {
    Bytes ids = ids_at(port, ServoState::kReady);
    if (reversed_[port]) std::reverse(ids.begin(), ids.end());
    const std::size_t answered = slow_[port] ? bus.sync_read(state_block_, state_bytes_, ids, use)
                                             : bus.fast_sync_read(state_block_, state_bytes_, ids, use);
    if (answered == ids.size()) return;
    // The servos behind a missing one are silent. In the next tick they are asked first.
    reversed_[port] = !reversed_[port];
    for (int i = 0; i < kRepetitions && ports_.now_ns() - begin_ns < config_.period_ns() / 4; ++i) {
      ids = ids_at(port, ServoState::kReady, true);
      if (ids.empty()) return;
      // The first servo may be the missing one. The servos after it wait for its answer, so they do not answer either.
      if (i > 0) ids.erase(ids.begin());
      bus.sync_read(state_block_, state_bytes_, ids, use);
    }
  });
}

void JointServos::lose(std::size_t index, const std::string& why) {
  Joint& joint = joints_[index];
  joint.state = ServoState::kLost;
  joint.misses = 0;
  joint.reading.rate_rad_s = 0.0;
  joint.reading.torque_nm = 0.0;
  joint.reading.torque_on = false;
  joint.reading.watchdog = 0;
  news_.push_back({fmt::format("{} {}; the robot holds", name_of(index), why)});
}

void JointServos::judge(std::size_t index) {
  Joint& joint = joints_[index];
  if (joint.state == ServoState::kLost) return;
  if (!joint.seen) {
    if (++joint.misses >= config_.lost_after_ticks || !ports_.is_open(joint.servo.port))
      lose(index, "does not answer (power, cable, id, baud rate?)");
    return;
  }
  if (joint.reading.voltage_v <= 0.0) return lose(index, "was started anew (its power failed?)");
  const bool tripped = joint.reading.watchdog == dynamixel::kWatchdogTripped;
  if (tripped && !joint.reported_lock)
    news_.push_back(
        {fmt::format("{} has stopped: its bus was silent for longer than servo.watchdog_s", name_of(index))});
  joint.reported_lock = tripped;
  const std::uint8_t errors = joint.reading.hardware_errors;
  if (errors != joint.reported_errors && errors != 0)
    news_.push_back(
        {fmt::format("{} reports {} ({} C, {:.1f} V)", name_of(index), dynamixel::hardware_error_text(errors),
                     joint.reading.temperature_c, joint.reading.voltage_v)});
  joint.reported_errors = errors;
  const bool off = errors != 0 && !joint.reading.torque_on;
  if (off && joint.state == ServoState::kReady && config_.reboot_on_error && joint.reboots < kMostReboots) {
    ++joint.reboots;
    ports_.with(joint.servo.port, news_, [&](serial::BusMaster& bus) { bus.reboot(joint.servo.id); });
    return lose(index, fmt::format("is started anew, attempt {} of {}", joint.reboots, kMostReboots));
  }
  if (off && joint.state == ServoState::kReady && joint.reading.torque_on == false) joint.state = ServoState::kShutDown;
  if (errors == 0) joint.state = ServoState::kReady;
}

void JointServos::measure() {
  for (Joint& joint : joints_) joint.seen = false;
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    if (ports_.reopen(port, news_)) read_port(port);
  }
  for (std::size_t i = 0; i < joints_.size(); ++i) judge(i);
  look_for_one_lost();
}

void JointServos::look_for_one_lost() {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    const std::size_t index = (next_lost_ + i) % joints_.size();
    Joint& joint = joints_[index];
    if (joint.state != ServoState::kLost || !ports_.is_open(joint.servo.port)) continue;
    next_lost_ = index + 1;
    ports_.with(joint.servo.port, news_, [&](serial::BusMaster& bus) {
      bus.set_slack(std::min(kSearchSlack_s, config_.answer_slack_s));
      const bool answers = bus.ping(joint.servo.id).good();
      bus.set_slack(config_.answer_slack_s);
      if (!answers) return;
      const std::string why = bring_up(bus, joint).why;
      if (why.empty()) news_.push_back({fmt::format("{} is back", name_of(index)), true});
      else if (why != joint.reported_failure) news_.push_back({fmt::format("{}: {}", name_of(index), why)});
      joint.reported_failure = why;
    });
    return;
  }
}

JointServos::Goal JointServos::goal_of(const Joint& joint, const JointSetpoint& setpoint) const {
  const dynamixel::ServoModel& model = plan_.model;
  const double torque_nm = setpoint.torque_mode ? std::abs(setpoint.torque_nm) : setpoint.torque_limit_nm;
  const std::int64_t current = joint.servo.current_units(model, torque_nm, joint.current_limit);
  double goal_rad = setpoint.position_rad;
  // A relaxed joint is moved by others: its goal follows, so that it does not jump when its torque comes back.
  if (setpoint.torque_limit_nm <= 0.0 || !joint.reading.torque_on) goal_rad = joint.reading.angle_rad;
  else if (setpoint.torque_mode) goal_rad = torque_goal_rad(joint, setpoint.torque_nm);
  // The first goal after torque mode is where the joint is. A profile would begin at the last goal, which was ahead.
  const bool profile = !setpoint.torque_mode && !joint.exerts;
  return {current, profile ? config_.profile_ms() : 0, joint.servo.steps(model, goal_rad)};
}

double JointServos::torque_goal_rad(const Joint& joint, double torque_nm) const {
  const double angle_rad = joint.reading.angle_rad;
  if (torque_nm == 0.0) return angle_rad;
  const double lead_rad = joint.limits.max_speed_rad_s * config_.control_period_s;
  return std::clamp(angle_rad + std::copysign(lead_rad, torque_nm), joint.limits.min_rad, joint.limits.max_rad);
}

void JointServos::command(std::span<const JointSetpoint> setpoints) {
  const dynamixel::ServoModel& model = plan_.model;
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    Bytes ids, goals, switched, torque;
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      Joint& joint = joints_[i];
      const bool obeys = joint.state == ServoState::kReady && joint.reading.watchdog != dynamixel::kWatchdogTripped;
      if (joint.servo.port != port || !obeys) continue;
      const bool on = setpoints[i].torque_limit_nm > 0.0;
      ids.push_back(joint.servo.id);
      const Goal goal = goal_of(joint, setpoints[i]);
      dynamixel::put_number(goals, goal.current, 2);
      dynamixel::put_number(goals, goal.profile_ms, 4);
      dynamixel::put_number(goals, goal.steps, 4);
      joint.exerts = setpoints[i].torque_mode;
      if (on == joint.reading.torque_on) continue;
      switched.push_back(joint.servo.id);
      torque.push_back(on ? 1 : 0);
    }
    if (ids.empty()) continue;
    ports_.with(port, news_, [&](serial::BusMaster& bus) {
      bus.sync_write(goal_block_, goal_bytes_, ids, goals);
      if (!switched.empty()) bus.sync_write(model.at("torque_enable").address, 1, switched, torque);
    });
  }
}

bool JointServos::complete() const {
  return std::all_of(joints_.begin(), joints_.end(),
                     [](const Joint& joint) { return joint.state == ServoState::kReady; });
}

bool JointServos::locked() const {
  return std::any_of(joints_.begin(), joints_.end(), [](const Joint& joint) {
    return joint.state != ServoState::kLost && joint.reading.watchdog == dynamixel::kWatchdogTripped;
  });
}

}  // namespace constrictor
