// Access to the servos at a serial port for commissioning, by the names of their registers.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "dynamixel/servo_model.hpp"
#include "serial/bus_master.hpp"

namespace constrictor::cli {

/// A device that answers.
struct FoundServo {
  std::uint8_t id = 0;
  std::uint16_t number = 0;  ///< of its model
  std::uint8_t firmware = 0;
  const dynamixel::ServoModel* model = nullptr;  ///< null: a model without a file, or a board with sensors

  /// "xm540_w150", or what else is known.
  [[nodiscard]] std::string model_name() const;
};

class ServoAccess {
 public:
  /// Opens the port. Throws serial::PortError.
  ServoAccess(const std::string& port, std::uint32_t baud);

  /// All devices that answer, by rising id.
  [[nodiscard]] std::vector<FoundServo> scan();
  /// The servo with this id. Throws std::runtime_error that says what to do if it does not answer or has no known
  /// model.
  [[nodiscard]] FoundServo find(std::uint8_t id);
  /// Whether a device with this id answers.
  [[nodiscard]] bool answers(std::uint8_t id) { return bus_.ping(id, kTries).arrived; }
  /// Reads or writes a register by its name. Throws std::runtime_error with the device's reason.
  [[nodiscard]] std::int64_t read(const FoundServo& servo, const std::string& reg);
  void write(const FoundServo& servo, const std::string& reg, std::int64_t value);

 private:
  static constexpr int kTries = 3;
  [[nodiscard]] FoundServo describe(std::uint8_t id, const serial::Answer& answer) const;

  std::string port_;
  std::map<std::uint16_t, dynamixel::ServoModel> models_;  ///< by number
  serial::BusMaster bus_;
};

}  // namespace constrictor::cli
