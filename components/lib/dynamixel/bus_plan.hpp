// Which device moves or measures which part of a robot, read from YAML.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "dynamixel/servo_model.hpp"

namespace constrictor::dynamixel {

/// A serial port with devices.
struct BusPort {
  std::string device;  ///< "/dev/ttyUSB0"; a relative path belongs to the output folder of the run
  std::uint32_t baud = 1'000'000;
};

/// The servo of one joint. Steps are those of the register present_position.
struct JointServo {
  std::size_t port = 0;
  std::uint8_t id = 1;
  int direction = 1;                  ///< 1, or -1: the servo turns against the joint
  double gear = 1.0;                  ///< turns of the servo for one turn of the joint
  std::int64_t zero_steps = 2048;     ///< position of the servo at the joint's angle 0
  double torque_constant_nm_a = 1.0;  ///< at the output of the servo

  /// [1/rad] steps of the servo for the joint's angle.
  [[nodiscard]] double steps_per_rad(const ServoModel& model) const {
    return direction * gear * model.steps_per_turn / (2.0 * std::numbers::pi);
  }
  [[nodiscard]] double angle_rad(const ServoModel& model, std::int64_t steps) const {
    return static_cast<double>(steps - zero_steps) / steps_per_rad(model);
  }
  /// The nearest step.
  [[nodiscard]] std::int64_t steps(const ServoModel& model, double angle_rad) const;
  [[nodiscard]] double rate_rad_s(const ServoModel& model, std::int64_t units) const {
    return static_cast<double>(units) * model.velocity_unit_rad_s / (direction * gear);
  }
  /// [Nm] about the joint's axis.
  [[nodiscard]] double torque_nm(const ServoModel& model, std::int64_t current_units) const {
    return static_cast<double>(current_units) * nm_per_unit(model);
  }
  /// The current that gives at most this torque: the amount, without sign, never above `limit`.
  [[nodiscard]] std::int64_t current_units(const ServoModel& model, double torque_nm, std::int64_t limit) const;

 private:
  [[nodiscard]] double nm_per_unit(const ServoModel& model) const {
    return direction * gear * torque_constant_nm_a * model.current_unit_a;
  }
};

/// A board with sensors (sensor_board.hpp).
struct SensorBoard {
  std::size_t port = 0;
  std::uint8_t id = 100;
};

struct BusPlan {
  ServoModel model;
  std::vector<BusPort> ports;
  std::vector<JointServo> joints;  ///< from head to tail
  std::optional<SensorBoard> imu;  ///< empty: the robot has no inertial unit on a bus
  /// Whether the devices are asked with Fast Sync Read; empty: the servos, if their firmware supports it, and the
  /// boards.
  std::optional<bool> fast_sync_read;
  std::vector<SensorBoard> contact_boards;  ///< one for each module, from the head; empty: no contact sensors

  /// The ids of the servos at a port, in the order of their joints.
  [[nodiscard]] Bytes servo_ids(std::size_t port) const;
};

/// Reads and checks a bus file. The model is a file in `models_folder`. Throws ConfigurationError, also if two devices
/// at a port have the same id, or if the positions of a joint would not fit into the servo's registers.
[[nodiscard]] BusPlan load_bus_plan(const std::filesystem::path& file, const std::filesystem::path& models_folder);

}  // namespace constrictor::dynamixel
