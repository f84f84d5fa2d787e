#include "dynamixel/instructions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "dynamixel/crc16.hpp"

namespace constrictor::dynamixel {
namespace {

void put_range(Bytes& parameters, std::uint16_t address, std::uint16_t count) {
  put_number(parameters, address, 2);
  put_number(parameters, count, 2);
}

void put_to_many(Bytes& to, Instruction instruction, std::uint16_t address, std::uint16_t count, ByteView ids) {
  Bytes parameters;
  put_range(parameters, address, count);
  parameters.insert(parameters.end(), ids.begin(), ids.end());
  put_packet(to, kBroadcast, instruction, parameters);
}

}  // namespace

const char* text_of(StatusError error) {
  switch (error) {
    case StatusError::kNone:
      return "no error";
    case StatusError::kResultFail:
      return "the device could not process the packet";
    case StatusError::kInstruction:
      return "the device does not know the instruction (is its firmware older?)";
    case StatusError::kCrc:
      return "the packet was damaged on the line (check cables, baud rate and termination)";
    case StatusError::kDataRange:
      return "the value does not fit into the register";
    case StatusError::kDataLength:
      return "the value has another length than the register";
    case StatusError::kDataLimit:
      return "the value is beyond the limits of the register";
    case StatusError::kAccess:
      return "the register is read-only, or in the EEPROM while the torque is on, or locked by a tripped watchdog";
  }
  return "unknown error";
}

std::int64_t get_number(ByteView at, std::size_t bytes, bool is_signed) {
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < bytes; ++i) number |= std::uint64_t{at[i]} << (8 * i);
  const std::uint64_t sign = std::uint64_t{1} << (8 * bytes - 1);
  if (is_signed && (number & sign) != 0) return static_cast<std::int64_t>(number) - static_cast<std::int64_t>(2 * sign);
  return static_cast<std::int64_t>(number);
}

void put_number(Bytes& to, std::int64_t number, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i)
    to.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(number) >> (8 * i)));
}

void put_packet(Bytes& to, std::uint8_t id, Instruction instruction, ByteView parameters) {
  const std::size_t begin = to.size();
  to.insert(to.end(), kHeader.begin(), kHeader.end());
  to.insert(to.end(), {id, 0, 0});
  const std::size_t body = to.size();
  const auto put = [&](std::uint8_t byte) {
    to.push_back(byte);
    if (to.size() >= body + 3 && std::equal(to.end() - 3, to.end(), kHeader.begin())) to.push_back(0xFD);
  };
  put(static_cast<std::uint8_t>(instruction));
  for (const std::uint8_t byte : parameters) put(byte);
  const std::size_t length = to.size() - body + kCrcBytes;
  if (length > kLargestLength)
    throw std::length_error(fmt::format("packet: found {} bytes, accepted at most {}", length, kLargestLength));
  to[begin + 5] = static_cast<std::uint8_t>(length & 0xFF);
  to[begin + 6] = static_cast<std::uint8_t>(length >> 8);
  put_number(to, crc16(ByteView(to).subspan(begin)), kCrcBytes);
}

void put_ping(Bytes& to, std::uint8_t id) { put_packet(to, id, Instruction::kPing, {}); }

void put_read(Bytes& to, std::uint8_t id, std::uint16_t address, std::uint16_t count) {
  Bytes parameters;
  put_range(parameters, address, count);
  put_packet(to, id, Instruction::kRead, parameters);
}

void put_write(Bytes& to, std::uint8_t id, std::uint16_t address, ByteView data) {
  Bytes parameters;
  put_number(parameters, address, 2);
  parameters.insert(parameters.end(), data.begin(), data.end());
  put_packet(to, id, Instruction::kWrite, parameters);
}

void put_reboot(Bytes& to, std::uint8_t id) { put_packet(to, id, Instruction::kReboot, {}); }

void put_clear_turns(Bytes& to, std::uint8_t id) {
  static constexpr std::array<std::uint8_t, 5> kOption = {0x01, 0x44, 0x58, 0x4C, 0x22};
  put_packet(to, id, Instruction::kClear, kOption);
}

void put_sync_read(Bytes& to, std::uint16_t address, std::uint16_t count, ByteView ids) {
  put_to_many(to, Instruction::kSyncRead, address, count, ids);
}

void put_fast_sync_read(Bytes& to, std::uint16_t address, std::uint16_t count, ByteView ids) {
  put_to_many(to, Instruction::kFastSyncRead, address, count, ids);
}

void put_sync_write(Bytes& to, std::uint16_t address, std::uint16_t count, ByteView ids, ByteView data) {
  if (data.size() != ids.size() * count)
    throw std::length_error(fmt::format("Sync Write: found {} bytes of data, accepted {} ({} for each of {} devices)",
                                        data.size(), ids.size() * count, count, ids.size()));
  Bytes parameters;
  put_range(parameters, address, count);
  for (std::size_t i = 0; i < ids.size(); ++i) {
    parameters.push_back(ids[i]);
    const ByteView part = data.subspan(i * count, count);
    parameters.insert(parameters.end(), part.begin(), part.end());
  }
  put_packet(to, kBroadcast, Instruction::kSyncWrite, parameters);
}

void put_status(Bytes& to, std::uint8_t id, std::uint8_t error, ByteView data) {
  Bytes parameters{error};
  parameters.insert(parameters.end(), data.begin(), data.end());
  put_packet(to, id, Instruction::kStatus, parameters);
}

bool fast_answer_is_right(ByteView bytes, std::size_t index, std::size_t count) {
  const std::size_t end = fast_answer_end(index, count);
  if (bytes.size() < end) return false;
  const auto crc = static_cast<std::uint16_t>(get_number(bytes.subspan(end - kCrcBytes), kCrcBytes, false));
  return crc16(bytes.first(end - kCrcBytes)) == crc;
}

}  // namespace constrictor::dynamixel
