// A pseudo-terminal: the emulator has one end, and the controller opens the other one as a serial port.
#pragma once

#include <cstdint>
#include <filesystem>

#include "dynamixel/protocol.hpp"

namespace constrictor::servo_emulator {

class PseudoTerminal {
 public:
  /// Opens a pseudo-terminal, and makes the link `link` to the controller's end; an older link is replaced. Throws
  /// std::system_error.
  explicit PseudoTerminal(std::filesystem::path link);
  /// Removes the link.
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Unplugs the adapter, which takes the port and the link away, or plugs it in again. Throws std::system_error.
  void plug(bool in);
  /// -1 while it is unplugged. Then nothing can be read, and bytes that are written are lost.
  [[nodiscard]] int descriptor() const { return master_; }
  [[nodiscard]] const std::filesystem::path& link() const { return link_; }
  /// [bit/s] that the controller has set.
  [[nodiscard]] std::uint32_t baud() const;
  /// Appends what the controller has written. Never waits.
  void read(dynamixel::Bytes& to) const;
  /// Bytes that the controller does not read in time are lost, as on a real port.
  void write(dynamixel::ByteView bytes) const;

 private:
  void open();
  void close();
  std::filesystem::path link_;
  int master_ = -1;
  int held_open_ = -1;  ///< the controller's end: without it, reads fail while no controller has opened the port
};

}  // namespace constrictor::servo_emulator
