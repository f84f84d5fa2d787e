// A second implementation of Protocol 2.0, written from its specification and as simple as possible: the CRC bit by
// bit, the stuffing as a replacement in a text. Tests compare the library with it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <random>
#include <sstream>
#include <string>

#include "dynamixel/protocol.hpp"

namespace constrictor::dynamixel::reference {

/// The bytes of a text such as "FF FF FD 00".
inline Bytes bytes_of(const std::string& text) {
  Bytes bytes;
  std::istringstream stream(text);
  for (unsigned value = 0; stream >> std::hex >> value;) bytes.push_back(static_cast<std::uint8_t>(value));
  return bytes;
}

inline std::string text_of(ByteView bytes) {
  std::string text;
  char digits[4];
  for (const std::uint8_t byte : bytes) {
    std::snprintf(digits, sizeof digits, "%02X", byte);
    text += (text.empty() ? "" : " ") + std::string(digits);
  }
  return text;
}

inline std::uint16_t crc(const Bytes& bytes) {
  std::uint32_t remainder = 0;
  for (const std::uint8_t byte : bytes) {
    for (int bit = 7; bit >= 0; --bit) {
      const bool in = ((byte >> bit) & 1) != 0;
      const bool out = (remainder & 0x8000) != 0;
      remainder = (remainder << 1) & 0xFFFF;
      if (in != out) remainder ^= 0x8005;
    }
  }
  return static_cast<std::uint16_t>(remainder);
}

/// Every occurrence of FF FF FD gets one more FD.
inline std::string stuffed(const Bytes& body) {
  std::string text(body.begin(), body.end());
  const std::string pattern = "\xFF\xFF\xFD";
  for (auto at = text.find(pattern); at != std::string::npos; at = text.find(pattern, at + 4))
    text.insert(at + 3, "\xFD");
  return text;
}

inline Bytes packet(std::uint8_t id, std::uint8_t instruction, const Bytes& parameters) {
  Bytes body;
  body.push_back(instruction);
  for (const std::uint8_t byte : parameters) body.push_back(byte);
  const std::string text = stuffed(body);
  const std::size_t length = text.size() + 2;
  Bytes whole = bytes_of("FF FF FD 00");
  whole.push_back(id);
  whole.push_back(static_cast<std::uint8_t>(length % 256));
  whole.push_back(static_cast<std::uint8_t>(length / 256));
  for (const char byte : text) whole.push_back(static_cast<std::uint8_t>(byte));
  const std::uint16_t sum = crc(whole);
  whole.push_back(static_cast<std::uint8_t>(sum % 256));
  whole.push_back(static_cast<std::uint8_t>(sum / 256));
  return whole;
}

/// Whether these bytes are one whole packet with a possible id: what a parser may at most accept.
inline bool is_packet(const Bytes& bytes) {
  if (bytes.size() < 10 || text_of(ByteView(bytes).first(4)) != "FF FF FD 00") return false;
  if (bytes[4] == 253 || bytes[4] == 255) return false;
  if (bytes.size() != 7u + bytes[5] + 256u * bytes[6]) return false;
  Bytes before = bytes;
  before.resize(bytes.size() - 2);
  return crc(before) == bytes[bytes.size() - 2] + 256 * bytes[bytes.size() - 1];
}

/// Random bytes of which many are those of the header.
class HeaderlikeBytes {
 public:
  explicit HeaderlikeBytes(std::uint64_t seed) : random_(seed) {}
  std::uint8_t operator()() {
    static constexpr std::uint8_t kOften[] = {0xFF, 0xFF, 0xFD, 0x00};
    return roll(2) == 0 ? kOften[roll(4)] : static_cast<std::uint8_t>(roll(256));
  }
  std::uint32_t roll(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }
  Bytes some(std::size_t most) {
    Bytes bytes(roll(static_cast<std::uint32_t>(most) + 1));
    for (auto& byte : bytes) byte = (*this)();
    return bytes;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace constrictor::dynamixel::reference
