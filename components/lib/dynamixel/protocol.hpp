// The words of DYNAMIXEL Protocol 2.0. Source: emanual.robotis.com/docs/en/dxl/protocol2
//
// A packet is: FF FF FD 00, id, length (2 bytes, low byte first), instruction, parameters, CRC (2 bytes, low byte
// first). `length` counts the bytes after it. Wherever FF FF FD occurs from the instruction to the last parameter, one
// more FD follows ("byte stuffing"), so that the header cannot occur inside of a packet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace constrictor::dynamixel {

using Bytes = std::vector<std::uint8_t>;
using ByteView = std::span<const std::uint8_t>;

inline constexpr std::array<std::uint8_t, 4> kHeader = {0xFF, 0xFF, 0xFD, 0x00};
inline constexpr std::uint8_t kLargestId = 252;
inline constexpr std::uint8_t kBroadcast = 254;  ///< every device obeys; a device answers only Ping and the reads
inline constexpr std::size_t kHeadBytes = 7;     ///< header, id, length
inline constexpr std::size_t kCrcBytes = 2;
/// [byte] The largest `length` that this library sends or accepts; a Sync Write to 64 servos needs 1,300.
inline constexpr std::size_t kLargestLength = 4096;

enum class Instruction : std::uint8_t {
  kPing = 0x01,
  kRead = 0x02,
  kWrite = 0x03,
  kReboot = 0x08,
  kClear = 0x10,
  kStatus = 0x55,  ///< the answer of a device
  kSyncRead = 0x82,
  kSyncWrite = 0x83,
  kFastSyncRead = 0x8A,
};

/// The lower seven bits of the error field of a status packet.
enum class StatusError : std::uint8_t {
  kNone = 0,
  kResultFail = 1,   ///< the device could not process the packet
  kInstruction = 2,  ///< unknown instruction
  kCrc = 3,          ///< wrong CRC
  kDataRange = 4,    ///< the value does not fit into the register
  kDataLength = 5,   ///< fewer bytes than the register has
  kDataLimit = 6,    ///< the value is beyond the limits of the register
  kAccess = 7,       ///< read-only or write-only register, EEPROM while the torque is on, or locked by a watchdog
};
/// Bit of the error field: the device has a hardware error; its register hardware_error_status shows which.
inline constexpr std::uint8_t kAlert = 0x80;

/// The error in words that say what to do.
[[nodiscard]] const char* text_of(StatusError error);

/// A packet without its stuffing.
struct PacketView {
  std::uint8_t id = 0;
  Instruction instruction = Instruction::kPing;
  ByteView parameters;  ///< of a status packet: the error field first

  [[nodiscard]] bool is_status() const { return instruction == Instruction::kStatus && !parameters.empty(); }
  /// The error of a status packet.
  [[nodiscard]] StatusError error() const { return static_cast<StatusError>(parameters[0] & 0x7F); }
  [[nodiscard]] bool alert() const { return (parameters[0] & kAlert) != 0; }
  [[nodiscard]] ByteView data() const { return parameters.subspan(1); }
};

/// A number of 1, 2 or 4 bytes, low byte first. `at` must have `bytes` bytes.
[[nodiscard]] std::int64_t get_number(ByteView at, std::size_t bytes, bool is_signed);
/// Appends the lowest `bytes` bytes of a number, low byte first.
void put_number(Bytes& to, std::int64_t number, std::size_t bytes);

}  // namespace constrictor::dynamixel
