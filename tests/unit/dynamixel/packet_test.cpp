// Packets of Protocol 2.0: compared with the examples of the manual, and with a second implementation.
#include <gtest/gtest.h>

#include <stdexcept>

#include "dynamixel/crc16.hpp"
#include "dynamixel/instructions.hpp"
#include "dynamixel/packet_parser.hpp"
#include "reference.hpp"

namespace constrictor::dynamixel {
namespace {

using reference::bytes_of;
using reference::text_of;

/// The packet that `put` makes.
template <class Put>
std::string made(Put&& put) {
  Bytes bytes;
  put(bytes);
  return text_of(bytes);
}

// The examples of emanual.robotis.com/docs/en/dxl/protocol2.
TEST(DynamixelPacket, AgreesWithTheManual) {
  EXPECT_EQ(made([](Bytes& to) { put_ping(to, 1); }), "FF FF FD 00 01 03 00 01 19 4E");
  EXPECT_EQ(made([](Bytes& to) { put_status(to, 1, 0, bytes_of("06 04 26")); }),
            "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D");
  EXPECT_EQ(made([](Bytes& to) { put_read(to, 1, 132, 4); }), "FF FF FD 00 01 07 00 02 84 00 04 00 1D 15");
  EXPECT_EQ(made([](Bytes& to) { put_status(to, 1, 0, bytes_of("A6 00 00 00")); }),
            "FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0");
  EXPECT_EQ(made([](Bytes& to) { put_write(to, 1, 116, bytes_of("00 02 00 00")); }),
            "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89");
  EXPECT_EQ(made([](Bytes& to) { put_status(to, 1, 0, {}); }), "FF FF FD 00 01 04 00 55 00 A1 0C");
  EXPECT_EQ(made([](Bytes& to) { put_reboot(to, 1); }), "FF FF FD 00 01 03 00 08 2F 4E");
  EXPECT_EQ(made([](Bytes& to) { put_clear_turns(to, 1); }), "FF FF FD 00 01 08 00 10 01 44 58 4C 22 B1 DC");
  EXPECT_EQ(made([](Bytes& to) { put_sync_read(to, 132, 4, bytes_of("01 02")); }),
            "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA");
  EXPECT_EQ(made([](Bytes& to) { put_sync_write(to, 116, 4, bytes_of("01 02"), bytes_of("96 0 0 0 AA 0 0 0")); }),
            "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87");
}

TEST(DynamixelPacket, FastSyncReadDiffersFromSyncReadInItsInstructionOnly) {
  Bytes fast;
  put_fast_sync_read(fast, 132, 4, bytes_of("03 07 04"));
  EXPECT_EQ(text_of(fast), text_of(reference::packet(254, 0x8A, bytes_of("84 00 04 00 03 07 04"))));
}

TEST(DynamixelPacket, TheCrcIsThatOfTheSpecification) {
  EXPECT_EQ(crc16(bytes_of("31 32 33 34 35 36 37 38 39")), 0xFEE8) << "check value of CRC-16/UMTS (BUYPASS)";
  reference::HeaderlikeBytes random(1);
  for (int i = 0; i < 2000; ++i) {
    const Bytes bytes = random.some(100);
    ASSERT_EQ(crc16(bytes), reference::crc(bytes)) << text_of(bytes);
    const std::size_t half = bytes.size() / 2;
    ASSERT_EQ(crc16(ByteView(bytes).subspan(half), crc16(ByteView(bytes).first(half))), reference::crc(bytes));
  }
}

TEST(DynamixelPacket, StuffingIsThatOfTheSpecification) {
  EXPECT_EQ(made([](Bytes& to) { put_write(to, 1, 0, bytes_of("FF FF FD")); }).substr(0, 41),
            "FF FF FD 00 01 09 00 03 00 00 FF FF FD FD");
  reference::HeaderlikeBytes random(2);
  for (int i = 0; i < 20000; ++i) {
    const Bytes parameters = random.some(40);
    const auto id = static_cast<std::uint8_t>(random.roll(253));
    const auto instruction = static_cast<std::uint8_t>(random.roll(10) == 0 ? 0xFF : random.roll(256));
    Bytes packet;
    put_packet(packet, id, static_cast<Instruction>(instruction), parameters);
    ASSERT_EQ(text_of(packet), text_of(reference::packet(id, instruction, parameters)));
    PacketParser parser;
    parser.add(packet);
    const auto found = parser.next();
    ASSERT_TRUE(found) << text_of(packet);
    EXPECT_EQ(found->id, id);
    EXPECT_EQ(static_cast<std::uint8_t>(found->instruction), instruction);
    ASSERT_EQ(text_of(found->parameters), text_of(parameters));
    ASSERT_EQ(parser.waiting(), 0u);
  }
}

TEST(DynamixelPacket, NumbersAreLittleEndianAndSigned) {
  EXPECT_EQ(get_number(bytes_of("FF"), 1, true), -1);
  EXPECT_EQ(get_number(bytes_of("FF"), 1, false), 255);
  EXPECT_EQ(get_number(bytes_of("00 80"), 2, true), -32768);
  EXPECT_EQ(get_number(bytes_of("01 00 00 80"), 4, true), -2147483647);
  EXPECT_EQ(get_number(bytes_of("01 00 00 80"), 4, false), 2147483649);
  for (const std::int64_t number : {-2147483648L, -1L, 0L, 1L, 2147483647L}) {
    Bytes bytes;
    put_number(bytes, number, 4);
    EXPECT_EQ(get_number(bytes, 4, true), number);
  }
}

TEST(DynamixelPacket, RefusesWhatDoesNotFit) {
  Bytes to;
  EXPECT_THROW(put_packet(to, 1, Instruction::kWrite, Bytes(kLargestLength)), std::length_error);
  EXPECT_THROW(put_sync_write(to, 116, 4, bytes_of("01 02"), bytes_of("00 00 00 00")), std::length_error);
}

/// The answer of devices 3, 7 and 4 with four bytes each, made from the specification.
Bytes fast_answer() {
  Bytes answer = bytes_of("FF FF FD 00 FE 19 00 55");
  for (const char* part : {"00 03 A6 00 00 00", "80 07 FF FF FD 00", "00 04 FF FF FD FD"}) {
    const Bytes bytes = bytes_of(part);
    answer.insert(answer.end(), bytes.begin(), bytes.end());
    const std::uint16_t sum = reference::crc(answer);
    answer.push_back(static_cast<std::uint8_t>(sum % 256));
    answer.push_back(static_cast<std::uint8_t>(sum / 256));
  }
  return answer;
}

TEST(DynamixelPacket, TheAnswerToAFastSyncReadIsTakenApart) {
  const Bytes answer = fast_answer();
  PacketParser parser;
  parser.add(answer);
  const auto packet = parser.next();
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->id, kBroadcast);
  std::string found;
  EXPECT_EQ(read_fast_answer(answer, 4,
                             [&](const FastAnswer& one) {
                               found += std::to_string(one.error) + "/" + std::to_string(one.id) + ": " +
                                        text_of(one.data) + "\n";
                             }),
            3u);
  EXPECT_EQ(found, "0/3: A6 00 00 00\n128/7: FF FF FD 00\n0/4: FF FF FD FD\n");
}

TEST(DynamixelPacket, ACutOffFastAnswerGivesTheDevicesBeforeTheCut) {
  const Bytes answer = fast_answer();
  const auto devices = [&](std::size_t bytes) {
    return read_fast_answer(ByteView(answer).first(bytes), 4, [](const FastAnswer&) {});
  };
  EXPECT_EQ(devices(answer.size() - 1), 2u);
  EXPECT_EQ(devices(fast_answer_end(1, 4)), 2u);
  EXPECT_EQ(devices(fast_answer_end(1, 4) - 1), 1u);
  EXPECT_EQ(devices(fast_answer_end(0, 4)), 1u);
  EXPECT_EQ(devices(8), 0u);
  EXPECT_EQ(devices(0), 0u);
}

}  // namespace
}  // namespace constrictor::dynamixel
