#include "constrictor/hex.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

namespace constrictor {
namespace {

// Source: RFC 4648, section 10.
TEST(Hex, HasTwoDigitsForEachByte) {
  constexpr std::array<std::uint8_t, 6> kFoobar{'f', 'o', 'o', 'b', 'a', 'r'};
  EXPECT_EQ(hex(kFoobar), "666f6f626172");
  EXPECT_EQ(bytes_of_hex("666F6F626172"), "foobar");
  EXPECT_EQ(hex({}), "");
  EXPECT_EQ(bytes_of_hex(""), "");
}

TEST(Hex, EveryByteComesBack) {
  for (int value = 0; value < 256; ++value) {
    const std::array<std::uint8_t, 1> byte{static_cast<std::uint8_t>(value)};
    EXPECT_EQ(std::stoi(hex(byte), nullptr, 16), value);
    EXPECT_EQ(bytes_of_hex(hex(byte)), std::string(1, static_cast<char>(byte[0])));
  }
}

TEST(Hex, RejectsWhatIsNotHexadecimal) {
  for (const char* text : {"6", "666", "6g", "g6", " 6", "6 ", "+6", "-6", "0x", "66 66", "66\n"})
    EXPECT_FALSE(bytes_of_hex(text)) << text;
}

}  // namespace
}  // namespace constrictor
