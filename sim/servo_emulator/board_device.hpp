// An emulated board with sensors (dynamixel/sensor_board.hpp).
#pragma once

#include <cstdint>

#include "constrictor/messages.hpp"
#include "dynamixel/servo_model.hpp"
#include "sim/servo_emulator/bus_device.hpp"

namespace constrictor::servo_emulator {

class BoardDevice final : public BusDevice {
 public:
  /// `model_number`: sensor_board::kImuModel or kContactModel.
  BoardDevice(std::uint16_t model_number, std::uint8_t id, std::uint32_t baud);

  [[nodiscard]] std::uint8_t id() const override { return memory_[kId]; }
  [[nodiscard]] std::uint32_t baud() const override { return dynamixel::kBaudRates[memory_[kBaud]]; }
  [[nodiscard]] std::int64_t return_delay_ns() const override { return 2000 * memory_[kDelay]; }
  [[nodiscard]] int status_return_level() const override { return 2; }
  [[nodiscard]] bool alert() const override { return false; }
  [[nodiscard]] std::uint16_t model_number() const override { return model_number_; }
  [[nodiscard]] std::uint8_t firmware() const override { return 1; }
  [[nodiscard]] bool knows_fast_sync_read() const override { return true; }
  dynamixel::StatusError read(std::uint16_t address, std::uint16_t count, dynamixel::Bytes& to) const override;
  /// Id, baud rate and return delay can be written; the measurements cannot.
  dynamixel::StatusError write(std::uint16_t address, dynamixel::ByteView data) override;
  dynamixel::StatusError clear_turns() override { return dynamixel::StatusError::kInstruction; }
  void reboot() override {}
  void heard(std::int64_t) override {}

  /// A numb board goes on answering and counting, but its contact sensor feels nothing.
  void make_numb(bool numb) { numb_ = numb; }

  /// A new measurement of the inertial unit.
  void measure(const msg::ImuState& imu);
  /// A new measurement of the contacts of one module, out of those of all modules.
  void measure(std::uint8_t module, const msg::ContactState& felt);

 private:
  static constexpr std::size_t kId = 7, kBaud = 8, kDelay = 9;
  void put(std::size_t address, double value, double unit);
  void put(std::size_t address, const msg::Vector3& value, double unit);
  void count();

  std::uint16_t model_number_;
  bool numb_ = false;
  dynamixel::Bytes memory_;
};

}  // namespace constrictor::servo_emulator
