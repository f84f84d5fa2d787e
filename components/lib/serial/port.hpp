// The serial port as a driver uses it. Tests replace it by an emulated line.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "dynamixel/protocol.hpp"

namespace constrictor::serial {

/// The port is gone or cannot be used; the message says what to do.
class PortError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class Port {
 public:
  Port() = default;
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;
  virtual ~Port() = default;

  /// Writes all bytes. Throws PortError if the port is gone.
  virtual void write(dynamixel::ByteView bytes) = 0;
  /// Appends what has arrived; waits for the first byte until `deadline_ns`. Returns whether there was any. Throws
  /// PortError if the port is gone.
  [[nodiscard]] virtual bool read(dynamixel::Bytes& to, std::int64_t deadline_ns) = 0;
  /// Drops what has arrived and was not read.
  virtual void drop_input() = 0;
  /// [ns] on a clock that never goes back.
  [[nodiscard]] virtual std::int64_t now_ns() const = 0;
  [[nodiscard]] virtual std::uint32_t baud() const = 0;
};

}  // namespace constrictor::serial
