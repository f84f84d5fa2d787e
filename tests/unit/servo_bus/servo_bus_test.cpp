// The driver of real servos as a plant: start, motion, refusals, hold, relax, stop, exit.
#include "driven_robot.hpp"

#include "configuration/configuration.hpp"

namespace constrictor {
namespace {

TEST_F(DrivenRobot, TheStartMovesNothing) {
  bench_.pass_until(500'000'000);  // the relaxed robot has come to rest
  next_tick_ns_ = 500'000'000;
  for (std::size_t i = 0; i < 23; ++i) {  // a trap: each servo would jump to an old goal
    bench_.robot->servo(i).set("operating_mode", 5);
    bench_.robot->servo(i).set("goal_position", 3000);
  }
  const auto before = posture();
  start();
  ticks(1);
  EXPECT_LT(moved_rad(before), 0.005);
  ticks(50);
  EXPECT_LT(moved_rad(before), 0.01);
  EXPECT_EQ(torques_on(), 23) << "the posture is held";
  EXPECT_EQ(mode(), GateMode::kHolding);
}

TEST_F(DrivenRobot, MeasuresWhatTheRobotDoes) {
  command_ = bend(0.2);
  start();
  ticks(100);
  const msg::JointState& state = *run_->latest(topics::kJointState);
  ASSERT_EQ(state.joint_count, 23);
  for (std::size_t i = 0; i < 23; ++i)
    EXPECT_NEAR(state.position_rad[i], true_angle_rad(i), 2 * M_PI / 4096) << "joint " << i;
  EXPECT_NEAR(run_->latest(topics::kImuState)->linear_acceleration_m_s2.z, 9.81, 0.5);
  const msg::ContactState& felt = *run_->latest(topics::kContactState);
  ASSERT_EQ(felt.module_count, 24);
  double weight_n = 0.0;
  for (int i = 0; i < 24; ++i) weight_n += felt.force_n[i].z;
  EXPECT_NEAR(weight_n, 24 * 0.3 * 9.81, 15.0);
  EXPECT_GT(felt.contact_count, 20);
}

TEST_F(DrivenRobot, FollowsACommandInTheRightDirection) {
  command_ = [](std::int64_t, msg::JointCommand& command) {
    command.position_rad[2] = 0.4;
    command.position_rad[3] = -0.1;  // its servo turns the other way
    return true;
  };
  start();
  ticks(100);
  EXPECT_EQ(mode(), GateMode::kObeying);
  EXPECT_NEAR(true_angle_rad(2), 0.4, 0.02);
  EXPECT_NEAR(true_angle_rad(3), -0.1, 0.04) << "the pitch joint carries the body";
}

// What the driver makes of the servos' currents is compared with what physics has in the hinges, at the same tick. Half
// of the servos turn against their joints.
TEST_F(DrivenRobot, MeasuresTheTorqueThatTheJointsBear) {
  std::vector<double> setpoints_rad(23, 0.0);
  command_ = [&](std::int64_t, msg::JointCommand& command) {
    std::copy(setpoints_rad.begin(), setpoints_rad.end(), command.position_rad);
    return true;
  };
  start();
  ticks(20);
  std::vector<double> largest_nm(23, 0.0);
  double furthest_nm = 0.0;
  const auto move_to = [&](std::size_t moved, double goal_rad, int count) {
    for (int tick = 0; tick < count; ++tick) {
      setpoints_rad[moved] += std::clamp(goal_rad - setpoints_rad[moved], -0.008, 0.008);
      ticks(1);
      for (std::size_t i = 0; i < 23; ++i) {
        const double true_nm = bench_.robot->world().joint_torque_nm(i);
        const double error_nm = std::abs(run_->latest(topics::kJointState)->torque_nm[i] - true_nm);
        EXPECT_LT(error_nm, 0.3) << "joint " << i << " bears " << true_nm << " Nm while joint " << moved << " moves";
        furthest_nm = std::max(furthest_nm, error_nm);
      }
      const double true_nm = bench_.robot->world().joint_torque_nm(moved);
      if (std::abs(true_nm) > std::abs(largest_nm[moved])) largest_nm[moved] = true_nm;
    }
  };
  for (std::size_t joint = 1; joint < 22; ++joint) {
    move_to(joint, 0.08, 20);
    move_to(joint, 0.0, 15);
    if (joint % 2 == 1) {
      EXPECT_GT(largest_nm[joint], 1.0) << "pitch joint " << joint << " lifts the body";
    }
  }
  std::printf("the measured torque differs from that of physics by %.2f Nm at most\n", furthest_nm);
}

TEST_F(DrivenRobot, TheTorqueLimitOfTheCommandIsThatOfTheServo) {
  command_ = [](std::int64_t, msg::JointCommand& command) {
    command.torque_limit_nm[4] = 1.3;
    return true;
  };
  start();
  ticks(10);
  const auto& servo = bench_.robot->servo(4);
  EXPECT_NEAR(static_cast<double>(servo.get("goal_current")) * 0.00269 * 7.3 / 4.4, 1.3, 0.005);
}

TEST_F(DrivenRobot, NeverAsksForALoadThatServosShutDownAt) {
  command_ = [](std::int64_t, msg::JointCommand& command) {
    command.torque_limit_nm[4] = 7.0;
    return true;
  };
  start();
  ticks(20);
  const double asked_a = static_cast<double>(bench_.robot->servo(4).get("goal_current")) * 0.00269;
  EXPECT_NEAR(asked_a, 0.75 * 4.4, 0.003);
}

TEST_F(DrivenRobot, AbsurdAndMissingCommandsAreRefusedAndThePostureIsHeld) {
  command_ = bend(0.2);
  start();
  ticks(60);
  const auto before = posture();
  for (const double absurd : {2.0, std::numeric_limits<double>::infinity(), std::nan("")}) {
    command_ = bend(absurd);
    ticks(10);
    EXPECT_EQ(mode(), GateMode::kHolding) << absurd;
  }
  command_ = [](std::int64_t, msg::JointCommand& command) { return command.joint_count = 22, true; };
  ticks(10);
  EXPECT_NE(last_refusal().find("wrong number of joints"), std::string::npos) << last_refusal();
  command_ = nullptr;
  ticks(20);
  EXPECT_EQ(mode(), GateMode::kHolding);
  EXPECT_LT(moved_rad(before), 0.05);
  ticks(250);
  EXPECT_EQ(mode(), GateMode::kRelaxed);
  EXPECT_EQ(torques_on(), 0);
}

TEST_F(DrivenRobot, ARelaxedRobotDoesNotJumpWhenItsTorqueComesBack) {
  start_relaxed();
  command_ = bend(0.3);
  double fastest_rad = 0.0;
  for (int i = 0; i < 40; ++i) {
    const auto before = posture();
    ticks(1);
    fastest_rad = std::max(fastest_rad, moved_rad(before));
  }
  EXPECT_LT(fastest_rad, 4.0 * 0.02 * 1.5) << "no joint is faster than its limit";
  EXPECT_EQ(torques_on(), 23);
  EXPECT_NEAR(true_angle_rad(0), 0.3, 0.03);
}

TEST_F(DrivenRobot, AnEmergencyStopIsObeyedAtOnce) {
  command_ = [](std::int64_t tick, msg::JointCommand& command) {
    return bend(0.5 * std::sin(0.05 * static_cast<double>(tick)))(tick, command);
  };
  start();
  ticks(100);
  order_stop();
  ticks(15);
  EXPECT_EQ(mode(), GateMode::kStopped);
  const auto stopped = posture();
  ticks(50);
  EXPECT_LT(moved_rad(stopped), 0.02);
  EXPECT_TRUE(run_->latest(topics::kStopState)->stopped);
}

TEST_F(DrivenRobot, OneRoundTakesTheTimeOfItsBytes) {
  command_ = bend(0.1);
  start();
  ticks(20);
  const std::int64_t before_ns = next_tick_ns_;
  ticks(1);
  const double round_s = static_cast<double>(bench_.now_ns - before_ns) * 1e-9;
  // Question and answer, ten bits a byte at 4 Mbit/s: servos (14 + 23; 8 + 23 * 20), inertial unit (14; 33) and contact
  // boards (14 + 24; 8 + 24 * 91). The Sync Write to the servos (14 + 23 * 7) is on the line when the round is over.
  const double bytes = 37 + 468 + 14 + 33 + 38 + 2192;
  EXPECT_NEAR(round_s, bytes * 10 / 4e6, 0.0002);
}

TEST_F(DrivenRobot, AsksServosAgainThatAreSilentAtTheStart) {
  command_ = bend(0.1);
  EXPECT_EQ(bench_.robot->command("silent 4"), "");
  EXPECT_EQ(bench_.robot->command("silent 9"), "");
  bench_.on_time = [this] {  // their power is switched on after 1 s
    if (bench_.now_ns > 1'000'000'000) static_cast<void>(bench_.robot->command("mend 0"));
  };
  start();
  ticks(20);
  EXPECT_EQ(torques_on(), 23);
  EXPECT_LT(bench_.now_ns, 2'000'000'000) << "no longer than needed";
}

TEST_F(DrivenRobot, AsksServosWithOlderFirmwareWithSyncRead) {
  bench_.robot->servo(6).set("firmware_version", 44);  // silent when it is asked with Fast Sync Read
  command_ = bend(0.3);
  start();
  ticks(100);
  EXPECT_EQ(driver().servos().slow_because(0),
            "servo 7 of joint 6 at bus0 has firmware 44, and Fast Sync Read needs 46");
  EXPECT_EQ(driver().servos().slow_because(1), "");
  EXPECT_EQ(mode(), GateMode::kObeying) << last_refusal();
  for (std::size_t i = 0; i < 23; i += 2) EXPECT_NEAR(std::abs(driver().servos().reading(i).angle_rad), 0.3, 0.05);
  EXPECT_EQ(run_->latest(topics::kContactState)->module_count, 24) << "the boards know Fast Sync Read";
}

TEST_F(DrivenRobot, TheBusFileDecidesOnFastSyncRead) {
  std::ifstream original(kProject / "deploy/buses/mamba_emulated.yaml");
  const std::string text{std::istreambuf_iterator<char>(original), {}};
  std::ofstream(config_.path() / "bus.yaml") << text << "fast_sync_read: false\n";
  start("bus_file: " + (config_.path() / "bus.yaml").string());
  ticks(20);
  EXPECT_EQ(driver().servos().slow_because(0), "fast_sync_read is false in the bus file");
  EXPECT_EQ(run_->latest(topics::kJointState)->joint_count, 23);
  EXPECT_EQ(run_->latest(topics::kContactState)->module_count, 24);
  EXPECT_EQ(run_->member("servo_bus").counters().refused, 0u) << last_refusal();
}

TEST_F(DrivenRobot, RefusesARobotWhoseServosDoNotFit) {
  const auto error = [this] {
    try {
      start();
      ticks(1);
    } catch (const ConfigurationError& found) {
      return std::string(found.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(bench_.robot->command("silent 4"), "");
  EXPECT_NE(error().find("1 of 23 servos cannot be started"), std::string::npos);
  EXPECT_NE(error().find("servo 5 of joint 4 at bus0: does not answer"), std::string::npos) << error();
  EXPECT_GT(bench_.now_ns, 4'000'000'000) << "twice the patience of servo.patience_s";
  EXPECT_EQ(bench_.robot->command("mend 0"), "");
  bench_.robot->servo(7).set("homing_offset", 1500);
  bench_.pass_until(bench_.now_ns + 100'000'000);
  EXPECT_EQ(torques_on(), 0) << "nothing was switched on";
  bench_.unplugged = true;
  EXPECT_EQ(error(), "the port is gone");
}

TEST_F(DrivenRobot, RefusesToRunFasterThanTheClock) {
  start();
  EXPECT_THROW(
      {
        for (int i = 0; i < 200; ++i) run_->advance(1);
      },
      ConfigurationError);
}

}  // namespace
}  // namespace constrictor
