// An emulated line: which devices answer and when, and what faults do.
#include <random>

#include "bus_fixture.hpp"

namespace constrictor::servo_emulator {
namespace {

using dynamixel::PacketParser;

class Line : public ::testing::Test {
 protected:
  Line() {
    for (std::uint8_t id = 1; id <= 3; ++id) servos_.push_back(std::make_unique<NamedServo>(id));
    std::vector<BusDevice*> devices;
    for (auto& servo : servos_) devices.push_back(&servo->device);
    line_ = std::make_unique<ServoLine>(devices, 1);
  }
  /// The answers to these bytes, as "id:data" with the data in decimal numbers; "!" marks an error.
  std::string ask(const Bytes& bytes, std::uint32_t baud = kBaud) {
    line_->receive(bytes, baud, now_ns_);
    PacketParser parser;
    times_.clear();
    for (const auto& sent : line_->outgoing()) {
      times_.push_back(sent.at_ns);
      parser.add(sent.bytes);
      last_ = sent.bytes;
      now_ns_ = sent.at_ns;
    }
    line_->outgoing().clear();
    std::string text;
    while (const auto packet = parser.next()) {
      text += std::to_string(packet->id) + ":";
      if (packet->error() != StatusError::kNone) text += "!" + std::to_string(static_cast<int>(packet->error()));
      for (const std::uint8_t byte : packet->data()) text += std::to_string(byte) + ",";
      text += " ";
    }
    return text;
  }
  template <class Put>
  static Bytes made(Put&& put) {
    Bytes bytes;
    put(bytes);
    return bytes;
  }

  std::vector<std::unique_ptr<NamedServo>> servos_;
  std::unique_ptr<ServoLine> line_;
  std::vector<std::int64_t> times_;
  Bytes last_;
  std::int64_t now_ns_ = 1'000'000;
};

const Bytes kPingAll = [] {
  Bytes bytes;
  dynamixel::put_ping(bytes, dynamixel::kBroadcast);
  return bytes;
}();

TEST_F(Line, EachServoAnswersItsPing) {
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_ping(to, 2); })), "2:106,4,46, ");  // 1130 and the firmware
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_ping(to, 9); })), "");
  EXPECT_EQ(ask(kPingAll), "1:106,4,46, 2:106,4,46, 3:106,4,46, ");
}

TEST_F(Line, AnswersTakeTheTimeOfTheirBytesAndTheReturnDelay) {
  now_ns_ = 5'000'000;
  ask(made([](Bytes& to) { dynamixel::put_ping(to, 1); }));
  // Ten bytes there, 14 bytes back, ten bits each at 1 Mbit/s, and 250 times 2 us.
  ASSERT_EQ(times_.size(), 1u);
  EXPECT_EQ(times_[0], 5'000'000 + 100'000 + 500'000 + 140'000);
}

TEST_F(Line, ReadsAndWritesReturnTheirErrors) {
  const auto read = [&](std::uint16_t address, std::uint16_t count) {
    return ask(made([&](Bytes& to) { dynamixel::put_read(to, 1, address, count); }));
  };
  EXPECT_EQ(read(132, 4), "1:0,8,0,0, ");
  EXPECT_EQ(read(250, 4), "1:!4 ");
  const Bytes one{1};
  EXPECT_EQ(ask(made([&](Bytes& to) { dynamixel::put_write(to, 1, 64, one); })), "1: ");
  EXPECT_EQ(ask(made([&](Bytes& to) { dynamixel::put_write(to, 1, 11, one); })), "1:!7 ");
  EXPECT_EQ(ask(made([&](Bytes& to) { dynamixel::put_packet(to, 1, dynamixel::Instruction{0x77}, {}); })), "1:!2 ");
  EXPECT_EQ(ask(made([&](Bytes& to) { dynamixel::put_reboot(to, 1); })), "1: ");
  EXPECT_EQ(servos_[0]->read("torque_enable"), 0);
}

TEST_F(Line, TheStatusReturnLevelSilencesAnswers) {
  servos_[0]->device.set("status_return_level", 1);
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_write(to, 1, 65, Bytes{1}); })), "");
  EXPECT_EQ(servos_[0]->read("led"), 1);
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_read(to, 1, 65, 1); })), "1:1, ");
  servos_[0]->device.set("status_return_level", 0);
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_read(to, 1, 65, 1); })), "");
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_ping(to, 1); })), "1:106,4,46, ");
}

TEST_F(Line, SyncWriteReachesAllAndNobodyAnswers) {
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_sync_write(to, 65, 1, Bytes{1, 3}, Bytes{1, 1}); })), "");
  EXPECT_EQ(servos_[0]->read("led") * 4 + servos_[1]->read("led") * 2 + servos_[2]->read("led"), 5);
}

TEST_F(Line, SyncReadIsAnsweredInTheOrderOfTheIds) {
  EXPECT_EQ(ask(made([](Bytes& to) { dynamixel::put_sync_read(to, 7, 1, Bytes{3, 1, 2}); })), "3:3, 1:1, 2:2, ");
  EXPECT_EQ(times_.size(), 3u);
  EXPECT_EQ(ask(made([](Bytes& to) {
              dynamixel::put_sync_read(to, 7, 1, Bytes{3, 9, 2});
            })),
            "3:3, ")
      << "the device after a missing one waits for its answer, and does not answer";
}

TEST_F(Line, FastSyncReadIsAnsweredInOnePacket) {
  ask(made([](Bytes& to) { dynamixel::put_fast_sync_read(to, 7, 1, Bytes{3, 1, 2}); }));
  std::string found;
  const auto use = [&](const dynamixel::FastAnswer& one) {
    found += std::to_string(one.id) + "=" + std::to_string(one.data[0]) + " ";
  };
  EXPECT_EQ(dynamixel::read_fast_answer(last_, 1, use), 3u);
  ask(made([](Bytes& to) { dynamixel::put_fast_sync_read(to, 7, 1, Bytes{1, 9, 2}); }));
  EXPECT_EQ(dynamixel::read_fast_answer(last_, 1, use), 1u);
  EXPECT_EQ(found, "3=3 1=1 2=2 1=1 ");
}

TEST_F(Line, AServoWithAnotherBaudRateIsDeaf) {
  EXPECT_EQ(ask(kPingAll, 57600), "");
  ASSERT_EQ(servos_[1]->write("baud_rate", 1), StatusError::kNone);
  EXPECT_EQ(ask(kPingAll, 57600), "2:106,4,46, ");
  EXPECT_EQ(ask(kPingAll), "1:106,4,46, 3:106,4,46, ");
}

TEST_F(Line, AnswersOfTwoServosWithOneIdDestroyEachOther) {
  servos_[2]->device.set("id", 2);
  const auto read = made([](Bytes& to) { dynamixel::put_read(to, 2, 132, 4); });
  EXPECT_EQ(ask(read), "2:0,8,0,0, ") << "equal answers look like one";
  servos_[2]->pass(0.004, {0.9, 0.0, 0.0});
  EXPECT_EQ(ask(read), "") << "their bits mix, and the CRC is wrong";
}

TEST_F(Line, BehindABrokenCableNobodyAnswers) {
  line_->faults.cable_broken_behind = 0;
  EXPECT_EQ(ask(kPingAll), "1:106,4,46, ");
  line_->faults = {};
  line_->faults.silent = {1};
  EXPECT_EQ(ask(kPingAll), "1:106,4,46, 3:106,4,46, ");
}

TEST_F(Line, SpoiltAnswersNeverLookRight) {
  const auto read = made([](Bytes& to) { dynamixel::put_read(to, 1, 132, 4); });
  line_->faults.damaged_bytes = 0.1;
  line_->faults.cut_answers = 0.2;
  line_->faults.noise_answers = 0.2;
  int right = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string answer = ask(read);
    if (answer.empty()) continue;
    EXPECT_EQ(answer, "1:0,8,0,0, ");
    ++right;
  }
  EXPECT_GT(right, 50);
  EXPECT_LT(right, 500);
}

TEST_F(Line, AnyInstructionFeedsTheWatchdogOfEveryServo) {
  ASSERT_EQ(servos_[0]->write("bus_watchdog", 3), StatusError::kNone);
  ASSERT_EQ(servos_[0]->write("torque_enable", 1), StatusError::kNone);
  for (int i = 0; i < 20; ++i) {
    servos_[0]->pass(0.04);
    now_ns_ = servos_[0]->now_ns;
    ask(made([](Bytes& to) { dynamixel::put_ping(to, 2); }));
  }
  EXPECT_EQ(servos_[0]->read("bus_watchdog"), 3);
  servos_[0]->pass(0.08);
  EXPECT_EQ(servos_[0]->read("bus_watchdog"), -1);
}

// Packets that are damaged in any way move nothing: a motion needs a whole packet with the right CRC.
TEST_F(Line, AMillionMutatedPacketsMoveNothing) {
  std::mt19937_64 random(11);
  const auto roll = [&](std::size_t below) { return static_cast<std::size_t>(random() % below); };
  for (auto& servo : servos_) {
    ASSERT_EQ(servo->write("operating_mode", 5), StatusError::kNone);
    ASSERT_EQ(servo->write("torque_enable", 1), StatusError::kNone);
  }
  Bytes goals(12);
  std::uint64_t sent = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    for (auto& byte : goals) byte = static_cast<std::uint8_t>(random());
    const auto id = static_cast<std::uint8_t>(1 + roll(3));
    Bytes packet;
    switch (roll(4)) {
      case 0:
        dynamixel::put_write(packet, id, 116, ByteView(goals).first(4));
        break;
      case 1:
        dynamixel::put_sync_write(packet, 116, 4, Bytes{1, 2, 3}, goals);
        break;
      case 2:
        dynamixel::put_write(packet, dynamixel::kBroadcast, 102, ByteView(goals).first(2));
        break;
      default:
        dynamixel::put_reboot(packet, id);
    }
    // Damage that the CRC finds for certain: one byte, or a cut.
    if (roll(3) == 0) {
      packet.resize(roll(packet.size() - 6));  // the header of the next packet could complete a longer rest
      dynamixel::put_read(packet, id, 132, 4);
    } else {
      // Not the length: a packet that ends elsewhere is compared with other bytes, and one in 65,536 would pass.
      std::size_t at = roll(packet.size() - 2);
      if (at >= 5) at += 2;
      packet[at] ^= static_cast<std::uint8_t>(1 + roll(255));
    }
    line_->receive(packet, kBaud, now_ns_ += 1000);
    sent += packet.size();
    line_->outgoing().clear();
    if (i % 1000 != 0) continue;
    for (auto& servo : servos_) {
      ASSERT_EQ(servo->read("torque_enable"), 1) << i;
      ASSERT_EQ(servo->read("goal_position"), 2048) << i;
      ASSERT_EQ(servo->read("goal_current"), 2047) << i;
    }
  }
  std::printf("%lu bytes\n", static_cast<unsigned long>(sent));
}

}  // namespace
}  // namespace constrictor::servo_emulator
