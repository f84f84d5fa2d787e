// What a board with the contact sensors of a module has room for.
#include "sim/servo_emulator/board_device.hpp"

#include <gtest/gtest.h>

#include "dynamixel/protocol.hpp"
#include "dynamixel/sensor_board.hpp"

namespace constrictor::servo_emulator {
namespace {

namespace map = dynamixel::sensor_board;

/// The x component of the force of contact `i` [N], read from the registers of the board.
double force_x_n(const BoardDevice& board, std::size_t i) {
  dynamixel::Bytes bytes;
  const auto at = static_cast<std::uint16_t>(map::contact::kFirst + i * map::contact::kBytesOfOne + 12);
  EXPECT_EQ(board.read(at, 2, bytes), dynamixel::StatusError::kNone);
  return map::kForce_n * static_cast<double>(dynamixel::get_number(bytes, 2, true));
}

std::uint8_t contacts(const BoardDevice& board) {
  dynamixel::Bytes bytes;
  EXPECT_EQ(board.read(map::contact::kContacts, 1, bytes), dynamixel::StatusError::kNone);
  return bytes.at(0);
}

// The belly has two contacts with the ground. The touch of an object is weaker at first, and must not be left out: the
// robot would push the object away before it feels it.
TEST(BoardDevice, ReportsALightTouchBesideTheContactsWithTheGround) {
  msg::ContactState felt{};
  const double forces_n[] = {2.0, 1.9, 1.8, 0.5};
  for (const double force_n : forces_n) felt.contacts[felt.contact_count++] = {3, {}, {}, {force_n, 0.0, 0.0}};
  felt.contacts[felt.contact_count++] = {4, {}, {}, {9.0, 0.0, 0.0}};
  BoardDevice board(map::kContactModel, 104, 4'000'000);
  board.measure(3, felt);
  ASSERT_EQ(contacts(board), 4);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(force_x_n(board, i), forces_n[i], 0.5 * map::kForce_n);
}

TEST(BoardDevice, LeavesOutTheWeakestOfTooManyContacts) {
  msg::ContactState felt{};
  for (int i = 0; i < 6; ++i) felt.contacts[felt.contact_count++] = {3, {}, {}, {6.0 - i, 0.0, 0.0}};
  BoardDevice board(map::kContactModel, 104, 4'000'000);
  board.measure(3, felt);
  ASSERT_EQ(contacts(board), map::contact::kMost);
  EXPECT_NEAR(force_x_n(board, map::contact::kMost - 1), 3.0, map::kForce_n);
}

}  // namespace
}  // namespace constrictor::servo_emulator
