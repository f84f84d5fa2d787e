#include "constrictor/text.hpp"

#include <cstdint>

namespace constrictor {
namespace {

/// [byte] length of the UTF-8 character at the start of `text`; 0 if there is none. Sets its code point.
std::size_t utf8_length(std::string_view text, std::uint32_t& code) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  const std::size_t length = first < 0x80 ? 1 : first >> 5 == 6 ? 2 : first >> 4 == 14 ? 3 : first >> 3 == 30 ? 4 : 0;
  if (length == 0 || length > text.size()) return 0;
  code = length == 1 ? first : first & (0x7fu >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  return code >= kLeast[length] && code <= 0x10ffff && (code < 0xd800 || code > 0xdfff) ? length : 0;
}

}  // namespace

std::string printable(std::string text, std::string_view kept) {
  for (std::size_t at = 0; at < text.size();) {
    std::uint32_t code = 0;
    const std::size_t length = utf8_length(std::string_view(text).substr(at), code);
    const bool control = code < 0x20 || (code >= 0x7f && code < 0xa0);
    if (length == 0 || (control && kept.find(text[at]) == std::string_view::npos))
      for (std::size_t i = 0; i < std::max<std::size_t>(length, 1); ++i) text[at + i] = '?';
    at += std::max<std::size_t>(length, 1);
  }
  return text;
}

}  // namespace constrictor
