#include "dynamixel/crc16.hpp"

#include <array>

namespace constrictor::dynamixel {
namespace {

constexpr std::uint32_t kPolynomial = 0x8005;

constexpr std::array<std::uint16_t, 256> make_table() {
  std::array<std::uint16_t, 256> table{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t remainder = byte << 8;
    for (int bit = 0; bit < 8; ++bit) remainder = (remainder << 1) ^ ((remainder & 0x8000) != 0 ? kPolynomial : 0);
    table[byte] = static_cast<std::uint16_t>(remainder);
  }
  return table;
}

constexpr std::array<std::uint16_t, 256> kTable = make_table();

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t before) {
  std::uint32_t crc = before;
  for (const std::uint8_t byte : bytes) crc = ((crc << 8) & 0xFFFF) ^ kTable[(crc >> 8) ^ byte];
  return static_cast<std::uint16_t>(crc);
}

}  // namespace constrictor::dynamixel
