// Access to the servos at a serial port for commissioning, by the names of their registers.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
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
  int devices = 1;  ///< that answer with this id; with more than one, no answer but that to a broadcast can be trusted

  /// "xm540_w150", or what else is known.
  [[nodiscard]] std::string model_name() const;
};

/// "two devices answer with id 5: ...", with the remedy.
[[nodiscard]] std::string two_devices(std::uint8_t id);

class ServoAccess {
 public:
  /// Opens the port. Throws serial::PortError.
  ServoAccess(const std::string& port, std::uint32_t baud);

  /// All devices that answer, by rising id. Asks again if answers were damaged.
  [[nodiscard]] std::vector<FoundServo> scan();
  /// The servos that answer. Throws std::runtime_error if there are none, or if two devices have one id.
  [[nodiscard]] std::vector<FoundServo> single_servos();
  /// The servo with this id. Throws std::runtime_error that says what to do if it does not answer or has no known
  /// model.
  [[nodiscard]] FoundServo find(std::uint8_t id);
  /// The same, but throws also if two devices have this id: both would obey.
  [[nodiscard]] FoundServo find_single(std::uint8_t id);
  /// Sends to this servo, or to all servos at the port, that its torque is to be switched off: kTries times, to the
  /// torque addresses of all known models, and without waiting for an answer.
  void order_torque_off(std::optional<std::uint8_t> id);
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
