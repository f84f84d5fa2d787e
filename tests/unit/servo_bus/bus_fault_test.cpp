// The driver on a bad day: cables, servos, power, noise, watchdog, and a successor after a crash.
#include "driven_robot.hpp"

namespace constrictor {
namespace {

/// Swings the yaw joints.
bool swing(std::int64_t tick, msg::JointCommand& command) {
  for (int i = 0; i < 23; i += 2)
    command.position_rad[i] = (i % 4 == 0 ? 0.4 : -0.4) * std::sin(0.06 * static_cast<double>(tick));
  return true;
}

class BusFault : public DrivenRobot {
 protected:
  /// Starts a robot that swings.
  void start_swinging(const std::string& config = "") {
    command_ = swing;
    start(config);
    ticks(60);
    ASSERT_EQ(mode(), GateMode::kObeying);
  }
  void expect_rest() {
    ticks(20);
    EXPECT_EQ(mode(), GateMode::kHolding);
    const auto before = posture();
    ticks(50);
    EXPECT_LT(moved_rad(before), 0.03);
  }
  /// The robot obeys again, and no joint has jumped on the way.
  void expect_swinging_again(int within_ticks) {
    double fastest_rad = 0.0;
    int tick = 0;
    for (; tick < within_ticks && mode() != GateMode::kObeying; ++tick) ticks(1);
    EXPECT_EQ(mode(), GateMode::kObeying) << last_refusal();
    for (int i = 0; i < 60; ++i) {
      const auto before = posture();
      ticks(1);
      fastest_rad = std::max(fastest_rad, moved_rad(before));
    }
    EXPECT_LT(fastest_rad, 4.0 * 0.02 * 1.6);
    EXPECT_EQ(torques_on(), 23);
  }
};

TEST_F(BusFault, APulledCableStopsTheRobotUntilItIsPluggedIn) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("cable 0 9"), "");
  for (int i = 0; i < 6 && mode() == GateMode::kObeying; ++i) ticks(1);
  EXPECT_EQ(mode(), GateMode::kHolding) << "after at most 6 ticks";
  EXPECT_NE(last_refusal().find("does not answer"), std::string::npos) << last_refusal();
  expect_rest();
  EXPECT_EQ(torques_on(), 10) << "the servos before the break hold";
  ASSERT_EQ(bench_.robot->command("mend 0"), "");
  expect_swinging_again(80);
}

TEST_F(BusFault, EventsAreLoggedOnceAndGoodNewsAreNoRefusals) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("cable 0 19"), "");
  ticks(20);
  EXPECT_EQ(logged(msg::kLogWarning, "does not answer (power, cable, id, baud rate?)"), 3);
  const std::uint64_t refused = run_->member("servo_bus").counters().refused;
  ASSERT_EQ(bench_.robot->command("mend 0"), "");
  ticks(40);
  EXPECT_EQ(logged(msg::kLogInfo, "is back"), 3) << "servos";
  EXPECT_EQ(logged(msg::kLogWarning, "is back"), 0);
  EXPECT_EQ(run_->member("servo_bus").counters().refused, refused) << last_refusal();
}

TEST_F(BusFault, OneServoThatIsSilentStopsTheRobot) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("silent 6"), "");
  expect_rest();
  EXPECT_EQ(driver().servos().state(6), ServoState::kLost);
  EXPECT_EQ(driver().servos().state(7), ServoState::kReady) << "the servos behind it are asked without it";
  EXPECT_NE(last_refusal().find("servo 7 of joint 6 at bus0 does not answer"), std::string::npos) << last_refusal();
}

TEST_F(BusFault, AStuckJointIsNamedAndTheRobotGoesOn) {
  start_swinging();
  EXPECT_EQ(last_refusal().find("does not move"), std::string::npos) << last_refusal();
  ASSERT_EQ(bench_.robot->command("stuck 6"), "");
  ticks(110);  // two windows of a second
  EXPECT_NE(last_refusal().find("servo 7 of joint 6 at bus0 does not move, although its goal moved by 0."),
            std::string::npos)
      << last_refusal();
  EXPECT_EQ(mode(), GateMode::kObeying);
  ASSERT_EQ(bench_.robot->command("heal 6"), "");
  ticks(110);
  EXPECT_EQ(logged(msg::kLogInfo, "servo 7 of joint 6 at bus0 moves again"), 1);
  EXPECT_EQ(last_refusal().find("moves again"), std::string::npos) << "good news are no refusals: " << last_refusal();
}

TEST(StuckWatch, AJointThatAGraspHoldsIsNotStuck) {
  StuckWatch watch(1, 50);
  const auto changes = [&](double goal_rad, double angle_rad, double torque_limit_nm) {
    return watch.look(std::vector<JointSetpoint>{{goal_rad, 0.0, torque_limit_nm}}, std::vector<double>{angle_rad});
  };
  std::size_t named = 0;
  for (int i = 0; i < 200; ++i) named += changes(1.0, 0.4, 3.0).size();            // the goal stands still
  for (int i = 0; i < 200; ++i) named += changes(0.01 * i, 0.4, 0.0).size();       // relaxed
  for (int i = 0; i < 200; ++i) named += changes(0.01 * i, 0.01 * i, 3.0).size();  // follows
  EXPECT_EQ(named, 0u);
  for (int i = 0; i < 100; ++i) named += changes(0.01 * i, 0.4, 3.0).size();
  EXPECT_EQ(named, 1u) << "once, not in every window";
}

TEST_F(BusFault, AServoThatStartsAnewIsConfiguredAgain) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("reboot 5"), "");
  ticks(3);
  expect_swinging_again(10);
  EXPECT_EQ(bench_.robot->servo(5).get("bus_watchdog"), 5);
}

TEST_F(BusFault, AnOverloadedServoStopsTheRobot) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("error 8 32"), "");
  expect_rest();
  EXPECT_NE(last_refusal().find("servo 9 of joint 8 at bus0 reports overload"), std::string::npos) << last_refusal();
  EXPECT_EQ(driver().servos().state(8), ServoState::kShutDown);
  EXPECT_EQ(torques_on(), 22);
}

TEST_F(BusFault, AnOverloadedServoIsRebootedWhereThatIsAllowed) {
  start_swinging("servo: {reboot_on_error: true}");
  for (int i = 0; i < 3; ++i) {
    ASSERT_EQ(bench_.robot->command("error 8 32"), "");
    ticks(3);
    expect_swinging_again(20);
  }
  ASSERT_EQ(bench_.robot->command("error 8 32"), "");
  expect_rest();
  EXPECT_EQ(driver().servos().state(8), ServoState::kShutDown) << "three times at most";
}

TEST_F(BusFault, ALowVoltageIsNamedAndDoesNotStopTheRobot) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("voltage 3 9.0"), "");
  ticks(10);
  EXPECT_EQ(mode(), GateMode::kObeying);
  EXPECT_NE(last_refusal().find("reports input voltage (25 C, 9.0 V)"), std::string::npos) << last_refusal();
}

TEST_F(BusFault, NoiseOnTheLineIsSurvivedByRetries) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("damage 0 0.0005"), "");  // a round has 500 bytes: every fifth answer is damaged
  ASSERT_EQ(bench_.robot->command("noise 0 0.1"), "");
  int obeying = 0;
  for (int i = 0; i < 300; ++i) {
    ticks(1);
    obeying += mode() == GateMode::kObeying ? 1 : 0;
  }
  EXPECT_GT(obeying, 290);
}

TEST_F(BusFault, TwoServosWithOneIdAreNoticedAsAServoThatDoesNotAnswer) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command("id 3 3"), "");  // joint 3 takes the id of joint 2
  ticks(10);
  EXPECT_EQ(mode(), GateMode::kHolding);
  EXPECT_NE(last_refusal().find("does not answer"), std::string::npos) << last_refusal();
}

TEST_F(BusFault, AnUnpluggedAdapterStopsTheServosByTheirWatchdogs) {
  start_swinging();
  bench_.unplugged = true;
  ticks(20);
  EXPECT_EQ(bench_.robot->servo(0).get("bus_watchdog"), -1);
  const auto before = posture();
  ticks(20);
  EXPECT_LT(moved_rad(before), 0.02);
  bench_.unplugged = false;
  ticks(100);
  EXPECT_EQ(mode(), GateMode::kStopped) << "an operator must clear the stop";
  EXPECT_STREQ(run_->latest(topics::kStopState)->source, "bus_watchdog");
  EXPECT_EQ(bench_.robot->servo(0).get("bus_watchdog"), -1) << "nothing is unlocked before";
  ASSERT_GT(patience_s_.size(), 4u);
  for (std::size_t i = 0; i < patience_s_.size(); ++i)
    EXPECT_EQ(patience_s_[i], i < 2 ? 10.0 : 0.0) << "attempt " << i << ": only the start may wait for a port";
}

TEST_F(BusFault, ASuccessorFindsTheServosLockedAndMovesNothing) {
  start_swinging();
  bench_.pass_until(bench_.now_ns + 300'000'000);
  next_tick_ns_ = bench_.now_ns;
  EXPECT_EQ(bench_.robot->servo(11).get("bus_watchdog"), -1);
  EXPECT_EQ(torques_on(), 23) << "the torque stays on";
  bench_.unplugged = true;  // a process that was killed has not released its servos
  run_->restart("servo_bus");
  bench_.unplugged = false;
  const auto before = posture();
  ticks(100);
  EXPECT_EQ(mode(), GateMode::kStopped);
  EXPECT_LT(moved_rad(before), 0.01);
  EXPECT_EQ(bench_.robot->servo(11).get("bus_watchdog"), -1);
}

/// A fault, and the ticks within which the robot must hold its posture.
struct Reaction {
  const char* name;
  const char* command;
  int most_ticks;
};

class BusReaction : public BusFault, public ::testing::WithParamInterface<Reaction> {};

// A servo that does not answer may be asked again in lost_after_ticks = 3 ticks. What a servo reports itself is known
// with the next reading.
TEST_P(BusReaction, TheRobotHoldsWithinItsBound) {
  start_swinging();
  ASSERT_EQ(bench_.robot->command(GetParam().command), "");
  int count = 0;
  double bus_ms = 0.0;
  for (; count < 20 && mode() == GateMode::kObeying; ++count) {
    const std::int64_t before_ns = std::max(bench_.now_ns, next_tick_ns_);
    ticks(1);
    bus_ms = std::max(bus_ms, static_cast<double>(bench_.now_ns - before_ns) * 1e-6);
  }
  std::printf("%s: holds after %d ticks (%d ms); longest time on the buses in a tick: %.1f ms\n", GetParam().name,
              count, 20 * count, bus_ms);
  EXPECT_EQ(mode(), GateMode::kHolding);
  EXPECT_LE(count, GetParam().most_ticks);
  EXPECT_LT(bus_ms, 40.0) << "less than half the time of the watchdogs, which must not trip";
}

INSTANTIATE_TEST_SUITE_P(EachFault, BusReaction,
                         ::testing::Values(Reaction{"cable", "cable 0 9", 3}, Reaction{"silent", "silent 6", 3},
                                           Reaction{"overload", "error 8 32", 1}, Reaction{"heat", "error 8 4", 1},
                                           Reaction{"shock", "error 8 16", 1}, Reaction{"wrong_id", "id 3 77", 3},
                                           Reaction{"double_id", "id 3 3", 3}, Reaction{"damage", "damage 0 0.3", 3}),
                         [](const auto& made) { return std::string(made.param.name); });

TEST_F(BusFault, WithoutContactSensorsTheRobotSaysSo) {
  std::ifstream original(kProject / "deploy/buses/mamba_emulated.yaml");
  std::string text{std::istreambuf_iterator<char>(original), {}};
  text = text.substr(0, text.find("contacts:"));
  std::ofstream(config_.path() / "bus.yaml") << text;
  command_ = swing;
  start("bus_file: " + (config_.path() / "bus.yaml").string());
  ticks(10);
  EXPECT_EQ(run_->latest(topics::kContactState)->module_count, 0);
  EXPECT_EQ(mode(), GateMode::kObeying);
}

}  // namespace
}  // namespace constrictor
