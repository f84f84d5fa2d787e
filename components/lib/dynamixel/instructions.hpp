// Makes the packets of Protocol 2.0. Every function appends one packet to `to`, complete with stuffing and CRC.
#pragma once

#include <cstdint>

#include "dynamixel/protocol.hpp"

namespace constrictor::dynamixel {

/// Any packet. Throws std::length_error if it would be longer than kLargestLength.
void put_packet(Bytes& to, std::uint8_t id, Instruction instruction, ByteView parameters);

void put_ping(Bytes& to, std::uint8_t id);
void put_read(Bytes& to, std::uint8_t id, std::uint16_t address, std::uint16_t count);
void put_write(Bytes& to, std::uint8_t id, std::uint16_t address, ByteView data);
/// The servo starts anew: its torque is off, and its hardware error is cleared.
void put_reboot(Bytes& to, std::uint8_t id);
/// Sets the position to its value within one turn (Clear, option 0x01).
void put_clear_turns(Bytes& to, std::uint8_t id);
void put_sync_read(Bytes& to, std::uint16_t address, std::uint16_t count, ByteView ids);
/// The same; all devices answer in one packet.
void put_fast_sync_read(Bytes& to, std::uint16_t address, std::uint16_t count, ByteView ids);
/// `data`: `count` bytes for each of `ids`, in their order.
void put_sync_write(Bytes& to, std::uint16_t address, std::uint16_t count, ByteView ids, ByteView data);

/// The answer of a device. `error`: a StatusError, perhaps with kAlert.
void put_status(Bytes& to, std::uint8_t id, std::uint8_t error, ByteView data);

/// One device's part of the answer to a Fast Sync Read.
struct FastAnswer {
  std::uint8_t error = 0;
  std::uint8_t id = 0;
  ByteView data;
};

/// Takes the answer to a Fast Sync Read apart. `bytes`: the answer as it came over the line, complete or cut off.
/// Calls `use(const FastAnswer&)` for each device, in their order, whose own CRC is right, and stops at the first other
/// one. `count`: bytes of data for each device. Returns the number of devices.
template <class Use>
std::size_t read_fast_answer(ByteView bytes, std::size_t count, Use&& use);

/// Number of the bytes of device `index` in the answer to a Fast Sync Read, counted from the header, its CRC included.
[[nodiscard]] constexpr std::size_t fast_answer_end(std::size_t index, std::size_t count) {
  return kHeadBytes + 1 + (index + 1) * (count + 4);
}
/// Number of devices whose answer to a Fast Sync Read is not longer than kLargestLength; at least 1.
[[nodiscard]] constexpr std::size_t fast_answer_devices(std::size_t count) {
  std::size_t devices = 1;
  while (fast_answer_end(devices, count) - kHeadBytes <= kLargestLength) ++devices;
  return devices;
}
/// Whether the CRC of device `index` is there and right.
[[nodiscard]] bool fast_answer_is_right(ByteView bytes, std::size_t index, std::size_t count);

template <class Use>
std::size_t read_fast_answer(ByteView bytes, std::size_t count, Use&& use) {
  std::size_t index = 0;
  for (; fast_answer_is_right(bytes, index, count); ++index) {
    const ByteView part = bytes.subspan(fast_answer_end(index, count) - count - 4);
    use(FastAnswer{part[0], part[1], part.subspan(2, count)});
  }
  return index;
}

}  // namespace constrictor::dynamixel
