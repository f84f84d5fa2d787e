// A serial port of Linux.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "serial/port.hpp"

namespace constrictor::serial {

class SerialPort final : public Port {
 public:
  /// Opens the device for this process alone: 8 bits, no parity, one stop bit, no flow control, and any baud rate that
  /// the adapter has. Asks the adapter to pass on each byte at once (low latency), if it can: otherwise an adapter with
  /// an FTDI chip collects bytes for up to 16 ms. Throws PortError.
  SerialPort(const std::filesystem::path& device, std::uint32_t baud);
  ~SerialPort() override;

  void write(dynamixel::ByteView bytes) override;
  [[nodiscard]] bool read(dynamixel::Bytes& to, std::int64_t deadline_ns) override;
  void drop_input() override;
  [[nodiscard]] std::int64_t now_ns() const override;
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }

 private:
  std::string name_;
  std::uint32_t baud_;
  int descriptor_ = -1;
};

/// Opens a port that may not be there yet: tries for at most `patience_s`. Throws the last PortError.
[[nodiscard]] std::unique_ptr<Port> wait_for_port(const std::filesystem::path& device, std::uint32_t baud,
                                                  double patience_s);

}  // namespace constrictor::serial
