// Questions and answers: bounds, repetitions and counts.
#include "serial/bus_master.hpp"

#include "driven_robot.hpp"

namespace constrictor {
namespace {

class Master : public DrivenRobot {
 protected:
  serial::BusMaster bus_{std::make_unique<EmulatedPort>(bench_, 0, 4'000'000), 0.004};
};

TEST_F(Master, FindsEveryDevice) {
  const auto found = bus_.ping_all();
  ASSERT_EQ(found.size(), 24u);
  EXPECT_EQ(found.front().first, 1);
  EXPECT_EQ(found.back().first, 100) << "the inertial unit";
}

TEST_F(Master, ASilentDeviceCostsABoundedTime) {
  const std::int64_t before_ns = bench_.now_ns;
  const serial::Answer answer = bus_.read(200, 132, 4, 3);
  EXPECT_FALSE(answer.arrived);
  EXPECT_LT(bench_.now_ns - before_ns, 3 * 5'000'000);
  EXPECT_EQ(bus_.counters().retries, 2u);
  EXPECT_EQ(bus_.counters().timeouts, 3u);
}

TEST_F(Master, ErrorsOfTheDeviceArriveAsWords) {
  const serial::Answer answer = bus_.write(1, 132, dynamixel::Bytes{0, 0, 0, 0});
  EXPECT_TRUE(answer.arrived);
  EXPECT_FALSE(answer.good());
  EXPECT_NE(answer.text().find("read-only"), std::string::npos);
  EXPECT_NE(serial::Answer{}.text().find("no answer"), std::string::npos);
}

TEST_F(Master, AnIncompleteFastAnswerGivesTheDevicesBeforeTheGap) {
  ASSERT_EQ(bench_.robot->command("silent 2"), "");
  std::string ids;
  const auto use = [&](std::uint8_t id, const serial::Answer& answer) {
    EXPECT_TRUE(answer.good());
    ids += std::to_string(id) + " ";
  };
  EXPECT_EQ(bus_.fast_sync_read(132, 4, dynamixel::Bytes{1, 2, 3, 4}, use), 2u);
  EXPECT_EQ(bus_.sync_read(132, 4, dynamixel::Bytes{4, 1, 3, 2}, use), 2u);
  EXPECT_EQ(ids, "1 2 4 1 ");
  EXPECT_EQ(bus_.fast_sync_read(132, 4, {}, use), 0u);
}

TEST_F(Master, AFastAnswerThatWouldBeTooLongIsAskedForInParts) {
  constexpr std::uint16_t kBytes = 200;
  dynamixel::Bytes ids;
  for (std::uint8_t id = 1; id <= 23; ++id) ids.push_back(id);
  ASSERT_GT(ids.size() * kBytes, dynamixel::kLargestLength);
  dynamixel::Bytes seen;
  const auto use = [&](std::uint8_t id, const serial::Answer& answer) {
    EXPECT_EQ(answer.data.size(), kBytes);
    EXPECT_EQ(answer.data.at(7), id) << "the register with the id";
    seen.push_back(id);
  };
  EXPECT_EQ(bus_.fast_sync_read(0, kBytes, ids, use), ids.size());
  EXPECT_EQ(seen, ids);
  EXPECT_EQ(bus_.counters().questions, 2u);

  // A gap in the first part: no servo behind it is asked.
  ASSERT_EQ(bench_.robot->command("silent 2"), "");
  seen.clear();
  EXPECT_EQ(bus_.fast_sync_read(0, kBytes, ids, use), 2u);
  EXPECT_EQ(seen, (dynamixel::Bytes{1, 2}));
}

TEST_F(Master, ALateAnswerIsNotTakenForThatOfTheNextQuestion) {
  dynamixel::Bytes question;
  dynamixel::put_read(question, 1, 132, 4);
  bench_.robot->line(0).receive(question, 4'000'000, bench_.now_ns);  // its answer comes uncalled
  bench_.pass_until(bench_.now_ns + 10'000'000);
  const serial::Answer answer = bus_.read(1, 7, 1);
  ASSERT_TRUE(answer.good());
  EXPECT_EQ(answer.data, dynamixel::Bytes{1});
  EXPECT_EQ(bus_.counters().late_bytes, 15u);
}

}  // namespace
}  // namespace constrictor
