// One emulated servo of the X series: its registers with their rules, its protections and its motion profile. Pure:
// what the joint does and what time it is are arguments.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "component/random.hpp"
#include "dynamixel/bus_plan.hpp"
#include "robot/joint_limits.hpp"
#include "sim/servo_emulator/bus_device.hpp"

namespace constrictor::servo_emulator {

/// State of the joint that the servo moves, from the simulated world. Sign and zero are those of the joint, not of the
/// servo.
struct JointMotion {
  double angle_rad = 0.0;
  double rate_rad_s = 0.0;
  double torque_nm = 0.0;  ///< of this moment, not filtered
};

/// Properties of the servo that are not in its registers.
struct ServoTraits {
  double supply_v = 12.0;
  double ambient_c = 25.0;
  double resistance_ohm = 2.7;       ///< of the winding: 12 V by the stall current
  double heat_capacity_j_k = 60.0;   ///< of 165 g
  double heat_resistance_k_w = 5.0;  ///< to the ambient air
  double current_noise_a = 0.01;     ///< standard deviation of the measured current
  double overload_share = 0.8;       ///< of the stall current, above which the servo counts overload
  double overload_s = 3.0;           ///< for so long, until it reports overload
  double strength = 1.0;             ///< the share of its torque that a worn servo still exerts
  double stiffness_nm_rad = 300.0;   ///< of its position control: for the current of a motor that cannot turn
};

class ServoDevice final : public BusDevice {
 public:
  /// A servo as it was commissioned: id and baud rate of the plan, everything else as from the factory.
  ServoDevice(const dynamixel::ServoModel& model, const dynamixel::JointServo& wiring, std::uint32_t baud,
              std::uint64_t seed, const ServoTraits& traits = {});

  [[nodiscard]] std::uint8_t id() const override { return static_cast<std::uint8_t>(get("id")); }
  [[nodiscard]] std::uint32_t baud() const override;
  [[nodiscard]] std::int64_t return_delay_ns() const override { return 2000 * get("return_delay_time"); }
  [[nodiscard]] int status_return_level() const override { return static_cast<int>(get("status_return_level")); }
  [[nodiscard]] bool alert() const override { return get("hardware_error_status") != 0; }
  [[nodiscard]] std::uint16_t model_number() const override { return model_.number; }
  [[nodiscard]] std::uint8_t firmware() const override { return static_cast<std::uint8_t>(get("firmware_version")); }
  [[nodiscard]] bool knows_fast_sync_read() const override { return firmware() >= model_.fast_sync_read_from; }
  dynamixel::StatusError read(std::uint16_t address, std::uint16_t count, dynamixel::Bytes& to) const override;
  dynamixel::StatusError write(std::uint16_t address, dynamixel::ByteView data) override;
  dynamixel::StatusError clear_turns() override;
  void reboot() override;
  void heard(std::int64_t now_ns) override { heard_ns_ = now_ns; }

  /// Lets the time `dt_s` pass, at whose end it is `now_ns` and the joint moves as given. Updates measurements,
  /// temperature, protections, watchdog and motion profile.
  void advance(double dt_s, std::int64_t now_ns, const JointMotion& motion);
  /// The drive of the joint during the next `dt_s`.
  [[nodiscard]] JointSetpoint order(double dt_s) const;

  /// The value of a register, and setting it without any rule: for faults and tests.
  [[nodiscard]] std::int64_t get(std::string_view name) const;
  void set(std::string_view name, std::int64_t value);
  /// Sets these bits of the register hardware_error_status; the servo shuts down as its register `shutdown` says.
  void fail(std::uint8_t errors);
  ServoTraits& traits() { return traits_; }
  /// The gear jams where the joint is now; the motor goes on pulling.
  void jam() { jam_rad_ = motion_.angle_rad; }
  /// The winding has this temperature from now on; it cools or warms from there.
  void heat(double temperature_c) { temperature_c_ = temperature_c; }
  /// Ends jam(), and gives the servo back its id and the traits that it had at first.
  void heal();
  [[nodiscard]] double temperature_c() const { return temperature_c_; }

 private:
  using Register = dynamixel::Register;
  using StatusError = dynamixel::StatusError;
  [[nodiscard]] std::int64_t value_of(const Register& reg) const;
  void store(const Register& reg, std::int64_t value);
  [[nodiscard]] bool torque_on() const { return value_of(*torque_enable_) != 0; }
  [[nodiscard]] bool tripped() const { return value_of(*watchdog_) == dynamixel::kWatchdogTripped; }
  /// The address behind a byte of the indirect data registers; other addresses stay.
  [[nodiscard]] std::uint16_t resolved(std::uint16_t address) const;
  [[nodiscard]] StatusError check(const Register& reg, std::int64_t value) const;
  StatusError write_directly(std::uint16_t address, dynamixel::ByteView data, bool apply);
  void apply(const Register& reg, std::int64_t value);
  void measure(const JointMotion& motion);
  /// The drive of the joint by the motor if the gear were not jammed.
  [[nodiscard]] JointSetpoint wanted(double dt_s) const;
  void protect(double dt_s, double current_a);
  void start_profile();
  [[nodiscard]] double profile_step(double dt_s) const;

  dynamixel::ServoModel model_;
  dynamixel::JointServo wiring_;
  ServoTraits traits_, healthy_;
  std::optional<double> jam_rad_;  ///< the angle at which the gear is jammed
  Random random_;
  dynamixel::Bytes memory_;
  const Register *torque_enable_, *watchdog_, *goal_position_, *goal_current_, *mode_;  ///< in model_.registers
  JointMotion motion_;
  double turns_steps_ = 0.0;      ///< that Clear has taken off the position
  double reference_steps_ = 0.0;  ///< where the motion profile is
  double profile_speed_ = 0.0;    ///< [steps/s]
  double temperature_c_;
  double overload_for_s_ = 0.0;
  std::int64_t heard_ns_ = 0;
  std::int64_t now_ns_ = 0;
};

}  // namespace constrictor::servo_emulator
