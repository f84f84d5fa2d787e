// The parser on a bad line: noise, pieces, cut-off and damaged packets. It loses no packet that is whole, and accepts
// none that is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "dynamixel/instructions.hpp"
#include "dynamixel/packet_parser.hpp"
#include "reference.hpp"

namespace constrictor::dynamixel {
namespace {

using reference::bytes_of;
using reference::HeaderlikeBytes;
using reference::text_of;

/// The ids of all packets that are ready.
std::string ids(PacketParser& parser) {
  std::string found;
  while (const auto packet = parser.next()) found += std::to_string(packet->id) + " ";
  return found;
}

TEST(PacketParser, TakesPacketsInPiecesOfAnySize) {
  Bytes line;
  for (std::uint8_t id = 1; id <= 5; ++id) put_read(line, id, 132, 4);
  for (std::size_t piece = 1; piece < 20; ++piece) {
    PacketParser parser;
    std::string found;
    for (std::size_t at = 0; at < line.size(); at += piece) {
      parser.add(ByteView(line).subspan(at, std::min(piece, line.size() - at)));
      found += ids(parser);
    }
    EXPECT_EQ(found, "1 2 3 4 5 ") << piece;
    EXPECT_EQ(parser.counters().skipped_bytes, 0u);
  }
}

TEST(PacketParser, SkipsNoiseBeforeAPacket) {
  PacketParser parser;
  parser.add(bytes_of("00 FF FF FF FD FF FF FD 01 FF"));
  Bytes ping;
  put_ping(ping, 9);
  parser.add(ping);
  EXPECT_EQ(ids(parser), "9 ");
  EXPECT_EQ(parser.counters().skipped_bytes, 10u);
  EXPECT_EQ(parser.counters().crc_errors, 0u);
}

TEST(PacketParser, APacketThatWasCutOffDoesNotHideTheNextOne) {
  Bytes line;
  put_write(line, 1, 0, Bytes(200, 0x11));
  line.resize(line.size() - 50);
  put_ping(line, 2);  // 10 bytes: fewer than the first packet lacks
  PacketParser parser;
  parser.add(line);
  EXPECT_EQ(ids(parser), "2 ");
  EXPECT_EQ(parser.counters().malformed, 1u);
}

TEST(PacketParser, CountsADamagedPacketAndFindsTheNextOne) {
  Bytes line;
  put_write(line, 1, 116, bytes_of("01 02 03 04"));
  line[11] ^= 0x40;
  put_ping(line, 2);
  PacketParser parser;
  parser.add(line);
  EXPECT_EQ(ids(parser), "2 ");
  EXPECT_EQ(parser.counters().crc_errors, 1u);
}

TEST(PacketParser, RefusesImpossibleIdsAndLengths) {
  PacketParser parser;
  for (const int id : {253, 255}) parser.add(reference::packet(static_cast<std::uint8_t>(id), 1, {}));
  parser.add(bytes_of("FF FF FD 00 01 02 00"));
  parser.add(bytes_of("FF FF FD 00 01 01 10"));  // 4097
  EXPECT_EQ(ids(parser), "");
  EXPECT_EQ(parser.counters().malformed, 4u);
  parser.add(reference::packet(3, 1, {}));
  EXPECT_EQ(ids(parser), "3 ");
}

TEST(PacketParser, ForgetsAnUnfinishedAnswer) {
  PacketParser parser;
  parser.add(bytes_of("FF FF FD 00 01 08 00 55 00"));
  EXPECT_EQ(ids(parser), "");
  EXPECT_EQ(parser.waiting(), 9u);
  parser.clear();
  EXPECT_EQ(parser.waiting(), 0u);
  EXPECT_EQ(parser.counters().skipped_bytes, 9u);
}

// Each accepted packet must be somewhere on the line, whole and with the CRC of the reference; and each undamaged
// packet that no damaged bytes touch must be accepted.
TEST(PacketParser, AMillionMutatedPackets) {
  constexpr int kPackets = 1'000'000;
  HeaderlikeBytes random(7);
  PacketParser parser;
  Bytes line;  // since the last check
  std::uint64_t accepted = 0;
  std::uint64_t untouched = 0;
  std::uint64_t untouched_found = 0;
  for (int i = 0; i < kPackets; ++i) {
    Bytes packet = reference::packet(static_cast<std::uint8_t>(random.roll(253)), static_cast<std::uint8_t>(random()),
                                     random.some(30));
    const std::uint32_t kind = random.roll(6);
    if (kind == 0) packet[random.roll(static_cast<std::uint32_t>(packet.size()))] = random();
    if (kind == 1) packet.resize(random.roll(static_cast<std::uint32_t>(packet.size())));
    if (kind == 2) packet.insert(packet.begin() + random.roll(static_cast<std::uint32_t>(packet.size())), random());
    if (kind == 3) packet.erase(packet.begin() + random.roll(static_cast<std::uint32_t>(packet.size())));
    line.insert(line.end(), packet.begin(), packet.end());
    std::size_t fed = 0;
    while (fed < packet.size()) {
      const std::size_t piece = std::min<std::size_t>(1 + random.roll(12), packet.size() - fed);
      parser.add(ByteView(packet).subspan(fed, piece));
      fed += piece;
      while (const auto found = parser.next()) {
        ++accepted;
        const Bytes whole = reference::packet(found->id, static_cast<std::uint8_t>(found->instruction),
                                              Bytes(found->parameters.begin(), found->parameters.end()));
        ASSERT_TRUE(reference::is_packet(whole));
        const auto at = std::search(line.begin(), line.end(), whole.begin(), whole.end());
        // A status packet of the broadcast id is the one kind that has no stuffing; the random ids leave it out.
        ASSERT_NE(at, line.end()) << "accepted, but not on the line: " << text_of(whole);
        if (whole == packet) ++untouched_found;
        line.erase(line.begin(), at + static_cast<std::ptrdiff_t>(whole.size()));
      }
    }
    if (kind > 3) ++untouched;
    ASSERT_LE(parser.waiting(), kHeadBytes + kLargestLength);
    if (line.size() > 3 * kLargestLength) line.erase(line.begin(), line.end() - 2 * kLargestLength);
  }
  std::printf("%d packets, of which %lu undamaged; %lu accepted, %lu CRC errors, %lu malformed\n", kPackets,
              static_cast<unsigned long>(untouched), static_cast<unsigned long>(accepted),
              static_cast<unsigned long>(parser.counters().crc_errors),
              static_cast<unsigned long>(parser.counters().malformed));
  EXPECT_GE(untouched_found, untouched * 98 / 100) << "a damaged length may swallow the beginning of the next packet";
}

}  // namespace
}  // namespace constrictor::dynamixel
