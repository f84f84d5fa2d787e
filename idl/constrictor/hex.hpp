// Bytes as hexadecimal text.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace constrictor {

/// Lower-case hexadecimal text, two digits a byte.
[[nodiscard]] std::string hex(std::span<const std::uint8_t> bytes);

/// The bytes of such text; digits may also be upper-case. Nothing if a character is no digit, or if their number is
/// odd.
[[nodiscard]] std::optional<std::string> bytes_of_hex(std::string_view text);

}  // namespace constrictor
