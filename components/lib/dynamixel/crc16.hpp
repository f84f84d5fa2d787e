// The checksum of Protocol 2.0.
#pragma once

#include <cstdint>
#include <span>

namespace constrictor::dynamixel {

/// CRC-16 with the polynomial x^16 + x^15 + x^2 + 1 (0x8005), the highest bit first, without inversion. `before`: the
/// result for the bytes that come before these ones; 0 at the beginning of a packet.
/// Source: emanual.robotis.com/docs/en/dxl/crc
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t before = 0);

}  // namespace constrictor::dynamixel
