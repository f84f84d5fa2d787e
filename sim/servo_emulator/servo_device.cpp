#include "sim/servo_emulator/servo_device.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace constrictor::servo_emulator {

using dynamixel::Bytes;
using dynamixel::ByteView;
using dynamixel::OperatingMode;
using dynamixel::StatusError;

namespace {

constexpr double kUnlimited_steps_s = 1e9;
constexpr std::int64_t kTimeBasedProfile = 1 << 2;  // bit of the register drive_mode
constexpr std::size_t kIndirect = 28;
constexpr double kJam_nm = 200.0;  // a jammed gear holds whatever the robot can exert

bool is_goal(const dynamixel::Register& reg) { return reg.name.starts_with("goal_"); }

}  // namespace

ServoDevice::ServoDevice(const dynamixel::ServoModel& model, const dynamixel::JointServo& wiring, std::uint32_t baud,
                         std::uint64_t seed, const ServoTraits& traits)
    : model_(model),
      wiring_(wiring),
      traits_(traits),
      healthy_(traits),
      random_(seed, "servo " + std::to_string(wiring.port) + "/" + std::to_string(wiring.id)),
      memory_(model.end(), 0),
      torque_enable_(&model_.at("torque_enable")),
      watchdog_(&model_.at("bus_watchdog")),
      goal_position_(&model_.at("goal_position")),
      goal_current_(&model_.at("goal_current")),
      mode_(&model_.at("operating_mode")),
      temperature_c_(traits.ambient_c) {
  for (const Register& reg : model_.registers) store(reg, reg.initial);
  set("id", wiring.id);
  const auto rate = std::find(std::begin(dynamixel::kBaudRates), std::end(dynamixel::kBaudRates), baud);
  set("baud_rate", rate - std::begin(dynamixel::kBaudRates));
  reboot();
}

std::uint32_t ServoDevice::baud() const { return dynamixel::kBaudRates[static_cast<std::size_t>(get("baud_rate"))]; }

std::int64_t ServoDevice::value_of(const Register& reg) const {
  return dynamixel::get_number(ByteView(memory_).subspan(reg.address), reg.bytes, reg.is_signed);
}

void ServoDevice::store(const Register& reg, std::int64_t value) {
  Bytes bytes;
  dynamixel::put_value(bytes, reg, value);
  std::copy(bytes.begin(), bytes.end(), memory_.begin() + reg.address);
}

std::int64_t ServoDevice::get(std::string_view name) const { return value_of(model_.at(name)); }

void ServoDevice::set(std::string_view name, std::int64_t value) { store(model_.at(name), value); }

std::uint16_t ServoDevice::resolved(std::uint16_t address) const {
  const std::uint16_t first = model_.at("indirect_data_1").address;
  if (address < first || address >= first + kIndirect) return address;
  const auto index = static_cast<std::size_t>(address - first);
  const std::size_t pointer = model_.at("indirect_address_1").address + 2 * index;
  return static_cast<std::uint16_t>(dynamixel::get_number(ByteView(memory_).subspan(pointer), 2, false));
}

StatusError ServoDevice::read(std::uint16_t address, std::uint16_t count, Bytes& to) const {
  if (address + count > memory_.size()) return StatusError::kDataRange;
  for (std::uint16_t i = 0; i < count; ++i) {
    const std::uint16_t at = resolved(static_cast<std::uint16_t>(address + i));
    to.push_back(at < memory_.size() ? memory_[at] : std::uint8_t{0});
  }
  return StatusError::kNone;
}

StatusError ServoDevice::check(const Register& reg, std::int64_t value) const {
  if (!reg.writable || (reg.eeprom() && torque_on())) return StatusError::kAccess;
  if (is_goal(reg) && tripped()) return StatusError::kDataRange;
  if (value < reg.min || value > reg.max) return StatusError::kDataRange;
  if (&reg == goal_current_ && std::abs(value) > get("current_limit")) return StatusError::kDataLimit;
  if (reg.name == "goal_velocity" && std::abs(value) > get("velocity_limit")) return StatusError::kDataLimit;
  if (reg.name == "goal_pwm" && std::abs(value) > get("pwm_limit")) return StatusError::kDataLimit;
  const bool one_turn = value_of(*mode_) == static_cast<std::int64_t>(OperatingMode::kPosition);
  if (&reg == goal_position_ && one_turn && (value < get("min_position_limit") || value > get("max_position_limit")))
    return StatusError::kDataLimit;
  const bool shut_down = (get("hardware_error_status") & get("shutdown")) != 0;
  if (&reg == torque_enable_ && value != 0 && shut_down) return StatusError::kResultFail;
  return StatusError::kNone;
}

StatusError ServoDevice::write_directly(std::uint16_t address, ByteView data, bool apply_it) {
  while (!data.empty()) {
    const Register* reg = model_.containing(address);
    if (!reg) return StatusError::kAccess;
    if (reg->address != address || data.size() < reg->bytes) return StatusError::kDataLength;
    const std::int64_t value = dynamixel::get_number(data, reg->bytes, reg->is_signed);
    if (apply_it) apply(*reg, value);
    else if (const StatusError error = check(*reg, value); error != StatusError::kNone) return error;
    address = static_cast<std::uint16_t>(address + reg->bytes);
    data = data.subspan(reg->bytes);
  }
  return StatusError::kNone;
}

StatusError ServoDevice::write(std::uint16_t address, ByteView data) {
  if (data.empty()) return StatusError::kDataLength;
  if (address + data.size() > memory_.size()) return StatusError::kDataRange;
  for (const bool apply_it : {false, true}) {
    for (std::size_t begin = 0; begin < data.size();) {
      // The bytes whose targets follow each other are one write.
      const std::uint16_t first = resolved(static_cast<std::uint16_t>(address + begin));
      std::size_t end = begin + 1;
      while (end < data.size() && resolved(static_cast<std::uint16_t>(address + end)) == first + (end - begin)) ++end;
      const StatusError error = write_directly(first, data.subspan(begin, end - begin), apply_it);
      if (error != StatusError::kNone) return error;
      begin = end;
    }
  }
  return StatusError::kNone;
}

void ServoDevice::apply(const Register& reg, std::int64_t value) {
  const bool was_on = torque_on();
  store(reg, value);
  if (&reg == torque_enable_ && value != 0 && !was_on) {
    reference_steps_ = static_cast<double>(get("present_position"));
    heard_ns_ = now_ns_;
    start_profile();
  }
  if (&reg == mode_) {
    set("goal_current", get("current_limit"));
    set("goal_position", get("present_position"));
  }
  if (&reg == goal_position_) start_profile();
}

StatusError ServoDevice::clear_turns() {
  if (torque_on()) return StatusError::kResultFail;
  const double turn = model_.steps_per_turn;
  turns_steps_ += std::floor(static_cast<double>(get("present_position")) / turn) * turn;
  measure(motion_);
  return StatusError::kNone;
}

void ServoDevice::reboot() {
  for (const Register& reg : model_.registers) {
    if (!reg.eeprom()) store(reg, reg.initial);
  }
  set("goal_current", get("current_limit"));
  turns_steps_ = 0.0;
  overload_for_s_ = 0.0;
  measure(motion_);
  reference_steps_ = static_cast<double>(get("present_position"));
  set("goal_position", get("present_position"));
  profile_speed_ = 0.0;
}

void ServoDevice::start_profile() {
  const auto profile = static_cast<double>(get("profile_velocity"));
  const double way = std::abs(static_cast<double>(value_of(*goal_position_)) - reference_steps_);
  const double limit = static_cast<double>(get("velocity_limit")) * model_.velocity_unit_rad_s * model_.steps_per_turn /
                       (2.0 * std::numbers::pi);
  profile_speed_ = kUnlimited_steps_s;  // "0 represents an infinite velocity"
  if (profile <= 0.0) return;
  const double wanted = (get("drive_mode") & kTimeBasedProfile) != 0
                            ? way / (1e-3 * profile)
                            : profile * model_.velocity_unit_rad_s * model_.steps_per_turn / (2.0 * std::numbers::pi);
  profile_speed_ = std::min(limit, wanted);
}

double ServoDevice::profile_step(double dt_s) const {
  if (tripped()) return 0.0;
  const double way = static_cast<double>(value_of(*goal_position_)) - reference_steps_;
  const double most = std::min(profile_speed_, kUnlimited_steps_s) * dt_s;
  return std::clamp(way, -most, most);
}

void ServoDevice::measure(const JointMotion& motion) {
  motion_ = motion;
  const double steps_per_rad = wiring_.steps_per_rad(model_);
  const double steps = static_cast<double>(wiring_.zero_steps) + motion.angle_rad * steps_per_rad - turns_steps_ +
                       static_cast<double>(get("homing_offset"));
  set("present_position", std::llround(steps));
  set("present_velocity",
      std::llround(motion.rate_rad_s * wiring_.direction * wiring_.gear / model_.velocity_unit_rad_s));
  set("present_input_voltage", std::llround(traits_.supply_v / model_.voltage_unit_v));
  set("present_temperature", std::clamp(std::llround(temperature_c_), 0LL, 255LL));
}

void ServoDevice::protect(double dt_s, double current_a) {
  using namespace dynamixel;
  const double heat_w = current_a * current_a * traits_.resistance_ohm;
  const double loss_w = (temperature_c_ - traits_.ambient_c) / traits_.heat_resistance_k_w;
  temperature_c_ += dt_s * (heat_w - loss_w) / traits_.heat_capacity_j_k;
  const bool loaded = std::abs(current_a) > traits_.overload_share * model_.stall_current_a;
  overload_for_s_ = loaded ? overload_for_s_ + dt_s : std::max(0.0, overload_for_s_ - dt_s);
  auto errors = static_cast<std::uint8_t>(get("hardware_error_status"));
  if (temperature_c_ > static_cast<double>(get("temperature_limit"))) errors |= hardware_error::kOverheating;
  if (overload_for_s_ > traits_.overload_s) errors |= hardware_error::kOverload;
  const auto voltage = get("present_input_voltage");
  if (voltage < get("min_voltage_limit") || voltage > get("max_voltage_limit")) errors |= hardware_error::kInputVoltage;
  fail(errors);
}

void ServoDevice::fail(std::uint8_t errors) {
  errors |= static_cast<std::uint8_t>(get("hardware_error_status"));
  set("hardware_error_status", errors);
  if ((errors & get("shutdown")) != 0) store(*torque_enable_, 0);
}

void ServoDevice::advance(double dt_s, std::int64_t now_ns, const JointMotion& motion) {
  now_ns_ = now_ns;
  reference_steps_ += torque_on() ? profile_step(dt_s) : 0.0;
  const double constant = wiring_.direction * wiring_.gear * wiring_.torque_constant_nm_a;
  double torque_nm = motion.torque_nm;
  if (jam_rad_) {  // the world shows the torque of the jam, not that of the motor
    const JointSetpoint to = wanted(dt_s);
    torque_nm = to.torque_mode ? to.torque_nm
                               : std::clamp(traits_.stiffness_nm_rad * (to.position_rad - motion.angle_rad),
                                            -to.torque_limit_nm, to.torque_limit_nm);
  }
  const double current_a = torque_on() ? torque_nm / (constant * traits_.strength) : 0.0;
  protect(dt_s, current_a);
  measure(motion);
  if (!torque_on()) reference_steps_ = static_cast<double>(get("present_position"));
  const double measured_a = current_a + (torque_on() ? traits_.current_noise_a * random_.normal() : 0.0);
  set("present_current", std::clamp(std::llround(measured_a / model_.current_unit_a), -32768LL, 32767LL));
  set("realtime_tick", now_ns / 1'000'000 % 32768);
  const std::int64_t watchdog = value_of(*watchdog_);
  const auto limit_ns = static_cast<std::int64_t>(1e9 * dynamixel::kWatchdogUnit_s) * watchdog;
  if (torque_on() && watchdog > 0 && now_ns - heard_ns_ > limit_ns) store(*watchdog_, dynamixel::kWatchdogTripped);
}

void ServoDevice::heal() {
  jam_rad_.reset();
  traits_ = healthy_;
  set("id", wiring_.id);
}

JointSetpoint ServoDevice::order(double dt_s) const {
  if (jam_rad_) return {*jam_rad_, 0.0, kJam_nm};
  return wanted(dt_s);
}

JointSetpoint ServoDevice::wanted(double dt_s) const {
  if (!torque_on()) return {motion_.angle_rad, 0.0, 0.0};
  const std::int64_t offset = get("homing_offset") - std::llround(turns_steps_);
  const double steps_per_rad = wiring_.steps_per_rad(model_);
  const auto angle_of = [&](double steps) {
    return (steps - static_cast<double>(wiring_.zero_steps + offset)) / steps_per_rad;
  };
  const auto mode = static_cast<OperatingMode>(value_of(*mode_));
  const std::int64_t current = mode == OperatingMode::kPosition ? get("current_limit") : value_of(*goal_current_);
  const double torque_nm = traits_.strength * wiring_.torque_nm(model_, current);
  if (mode == OperatingMode::kCurrent) {
    if (tripped()) return {motion_.angle_rad, 0.0, 0.0};
    return {motion_.angle_rad, 0.0, std::abs(torque_nm), torque_nm, true};
  }
  const double step = profile_step(dt_s);
  // A goal without a profile is a step of the reference, which has no rate.
  const double rate_rad_s = profile_speed_ < kUnlimited_steps_s ? step / (steps_per_rad * dt_s) : 0.0;
  return {angle_of(reference_steps_ + step), rate_rad_s, std::abs(torque_nm)};
}

}  // namespace constrictor::servo_emulator
