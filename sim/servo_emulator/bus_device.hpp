// A device on an emulated bus: a servo, or a board with sensors.
#pragma once

#include <cstdint>

#include "dynamixel/protocol.hpp"

namespace constrictor::servo_emulator {

/// Time is an argument: [ns] since the emulator began.
class BusDevice {
 public:
  BusDevice() = default;
  BusDevice(const BusDevice&) = delete;
  BusDevice& operator=(const BusDevice&) = delete;
  virtual ~BusDevice() = default;

  [[nodiscard]] virtual std::uint8_t id() const = 0;
  [[nodiscard]] virtual std::uint32_t baud() const = 0;
  [[nodiscard]] virtual std::int64_t return_delay_ns() const = 0;
  /// 0: it answers Ping only; 1: also reads; 2: everything.
  [[nodiscard]] virtual int status_return_level() const = 0;
  [[nodiscard]] virtual bool alert() const = 0;
  [[nodiscard]] virtual std::uint16_t model_number() const = 0;
  [[nodiscard]] virtual std::uint8_t firmware() const = 0;
  /// Older firmware does not support Fast Sync Read.
  [[nodiscard]] virtual bool knows_fast_sync_read() const = 0;

  /// Appends `count` bytes from `address` on.
  virtual dynamixel::StatusError read(std::uint16_t address, std::uint16_t count, dynamixel::Bytes& to) const = 0;
  /// Writes all bytes or, if there is an error, none.
  virtual dynamixel::StatusError write(std::uint16_t address, dynamixel::ByteView data) = 0;
  virtual dynamixel::StatusError clear_turns() = 0;
  virtual void reboot() = 0;
  /// The device has received a whole instruction packet, for itself or for another device.
  virtual void heard(std::int64_t now_ns) = 0;
};

}  // namespace constrictor::servo_emulator
