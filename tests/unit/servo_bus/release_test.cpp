// How the driver leaves the servos when it ends, and how the next run finds them.
#include "driven_robot.hpp"

namespace constrictor {
namespace {

TEST_F(DrivenRobot, TheTorqueIsOffWhenTheProcessEndsInOrder) {
  command_ = bend(0.1);
  start();
  ticks(20);
  EXPECT_EQ(torques_on(), 23);
  run_.reset();
  EXPECT_EQ(torques_on(), 0);
}

TEST_F(DrivenRobot, ASecondRunBeginsWithoutAStop) {
  for (const std::int64_t silence_ns : {0, 300'000'000}) {  // between the last tick and the release
    command_ = bend(0.1);
    start();
    ticks(20);
    EXPECT_EQ(mode(), GateMode::kObeying) << last_refusal();
    bench_.pass_until(bench_.now_ns + silence_ns);
    EXPECT_EQ(bench_.robot->servo(4).get("bus_watchdog"), silence_ns == 0 ? 5 : -1);
    driver().release_device();
    EXPECT_EQ(torques_on(), 0);
    for (std::size_t i = 0; i < 23; ++i) EXPECT_EQ(bench_.robot->servo(i).get("bus_watchdog"), 0) << "joint " << i;
    const std::uint64_t sent = bench_.bytes_sent;
    run_.reset();
    EXPECT_EQ(bench_.bytes_sent, sent) << "it is released once";
    bench_.pass_until(bench_.now_ns + 500'000'000);
    next_tick_ns_ = bench_.now_ns;
  }
  start();
  ticks(20);
  EXPECT_EQ(mode(), GateMode::kObeying) << last_refusal();
}

TEST_F(DrivenRobot, ServosThatKeepTheirTorqueDoNotStopTheNextRun) {
  command_ = bend(0.1);
  start("servo: {torque_off_at_exit: false}");
  ticks(60);
  run_.reset();
  EXPECT_EQ(torques_on(), 23);
  const auto before = posture();
  bench_.pass_until(bench_.now_ns + 300'000'000);
  next_tick_ns_ = bench_.now_ns;
  EXPECT_EQ(bench_.robot->servo(4).get("bus_watchdog"), 0);
  start();
  ticks(20);
  EXPECT_EQ(mode(), GateMode::kObeying) << last_refusal();
  EXPECT_LT(moved_rad(before), 0.02);
}

TEST_F(DrivenRobot, ASilentServoDoesNotKeepTheOthersFromBeingReleased) {
  start();
  ticks(20);
  ASSERT_EQ(bench_.robot->command("silent 0"), "");
  ASSERT_EQ(bench_.robot->command("silent 22"), "");
  run_.reset();
  EXPECT_EQ(torques_on(), 2);
  for (std::size_t i = 1; i < 22; ++i) EXPECT_EQ(bench_.robot->servo(i).get("bus_watchdog"), 0) << "joint " << i;
}

}  // namespace
}  // namespace constrictor
