// The register table of a servo model, read from YAML.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "dynamixel/protocol.hpp"

namespace constrictor::dynamixel {

/// One register. Values are whole numbers in the units of the register.
struct Register {
  std::string name;
  std::uint16_t address = 0;
  std::uint8_t bytes = 1;
  bool writable = false;
  bool is_signed = false;
  std::int64_t min = 0;  ///< accepted values of a writable register
  std::int64_t max = 0;
  std::int64_t initial = 0;  ///< of a new servo; of a RAM register: after each start

  /// The EEPROM keeps its values without power, and can be written only while the torque is off.
  [[nodiscard]] bool eeprom() const { return address < kRamBegin; }
  static constexpr std::uint16_t kRamBegin = 64;
};

/// The values of the register operating_mode that this project uses.
enum class OperatingMode : std::uint8_t { kCurrent = 0, kPosition = 3, kCurrentBasedPosition = 5 };

/// Bits of the register hardware_error_status.
namespace hardware_error {
inline constexpr std::uint8_t kInputVoltage = 1 << 0;
inline constexpr std::uint8_t kOverheating = 1 << 2;
inline constexpr std::uint8_t kEncoder = 1 << 3;
inline constexpr std::uint8_t kElectricalShock = 1 << 4;
inline constexpr std::uint8_t kOverload = 1 << 5;
}  // namespace hardware_error

/// The errors in words: "overload, overheating"; "none".
[[nodiscard]] std::string hardware_error_text(std::uint8_t bits);

/// Value of the register bus_watchdog after the bus was silent for too long.
inline constexpr std::int64_t kWatchdogTripped = -1;
inline constexpr double kWatchdogUnit_s = 0.02;

/// Baud rates in the order of the values of the register baud_rate.
inline constexpr std::uint32_t kBaudRates[] = {9600, 57600, 115200, 1000000, 2000000, 3000000, 4000000, 4500000};

struct ServoModel {
  std::string name;
  std::uint16_t number = 0;  ///< register model_number
  double steps_per_turn = 4096.0;
  double current_unit_a = 0.00269;
  double velocity_unit_rad_s = 0.0;
  double voltage_unit_v = 0.1;
  double stall_torque_nm = 0.0;
  double stall_current_a = 0.0;
  double no_load_speed_rad_s = 0.0;
  int fast_sync_read_from = 46;     ///< first firmware that supports Fast Sync Read
  std::vector<Register> registers;  ///< by rising address, without overlap

  /// The register with this name. Throws std::out_of_range if the model has none.
  [[nodiscard]] const Register& at(std::string_view name) const;
  /// The register that contains this address; null: none.
  [[nodiscard]] const Register* containing(std::uint16_t address) const;
  /// One after the last address.
  [[nodiscard]] std::uint16_t end() const;
  /// [Nm/A] at the output of the gear.
  [[nodiscard]] double torque_constant_nm_a() const { return stall_torque_nm / stall_current_a; }
};

/// Appends the value of a register as its bytes.
void put_value(Bytes& to, const Register& reg, std::int64_t value);

/// Reads and checks the file of a model, and the table of registers that it names (a file beside it). Throws
/// ConfigurationError.
[[nodiscard]] ServoModel load_servo_model(const std::filesystem::path& file);

}  // namespace constrictor::dynamixel
