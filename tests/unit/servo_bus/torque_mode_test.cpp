// Torque mode on emulated servos: what the registers say, what the joints do, and how it ends.
#include "driven_robot.hpp"

namespace constrictor {
namespace {

constexpr double kNmPerUnit = 0.00269 * 7.3 / 4.4;  // of the servo's current, by its data sheet
constexpr double kLimit_rad = 1.5;                  // of the robot's joints

/// Pushes one joint; the others exert no torque.
testing::CommandAt push(std::size_t joint, double torque_nm) {
  return [=](std::int64_t, msg::JointCommand& command) {
    command.mode = msg::kServoTorque;
    command.torque_nm[joint] = torque_nm;
    return true;
  };
}

TEST_F(DrivenRobot, ATorqueTurnsItsJointInItsDirection) {
  start();
  ticks(10);
  for (const std::size_t joint : {0u, 6u, 7u}) {  // the servo of joint 7 turns against its joint
    const double before_rad = true_angle_rad(joint);
    const double torque_nm = joint == 6 ? -1.2 : 1.2;
    command_ = push(joint, torque_nm);
    ticks(3);
    EXPECT_EQ(mode(), GateMode::kObeying);
    EXPECT_TRUE(driver().gate().torque);
    ticks(9);
    EXPECT_GT((true_angle_rad(joint) - before_rad) * torque_nm, 0.05) << "joint " << joint;
    command_ = bend(0.0);
    ticks(60);
  }
}

TEST_F(DrivenRobot, TheServoIsAskedForTheCurrentOfTheTorqueAndForAGoalAhead) {
  start();
  ticks(10);
  command_ = push(4, 0.8);
  ticks(2);
  for (int i = 0; i < 20; ++i) {
    ticks(1);
    const double measured_rad = run_->latest(topics::kJointState)->position_rad[4];
    const auto& servo = bench_.robot->servo(4);
    const double goal_rad = plan_.joints[4].angle_rad(plan_.model, servo.get("goal_position"));
    EXPECT_NEAR(static_cast<double>(servo.get("goal_current")) * kNmPerUnit, 0.8, kNmPerUnit);
    EXPECT_NEAR(goal_rad, measured_rad + 4.0 * 0.02, 2 * M_PI / 4096) << "as far as the joint can come in one tick";
    EXPECT_EQ(servo.get("profile_velocity"), 0);
    EXPECT_EQ(servo.get("operating_mode"), 5) << "the mode is in the EEPROM, and changing it needs the torque off";
    EXPECT_EQ(servo.get("torque_enable"), 1);
    EXPECT_EQ(bench_.robot->servo(5).get("goal_current"), 0) << "the others are free";
    EXPECT_LE(std::abs(bench_.robot->world().joint(4).step_torque_nm()), 0.8 + 0.01);
  }
}

TEST_F(DrivenRobot, NoTorquePushesAJointBeyondItsLimitNorFasterThanItsMaximumSpeed) {
  start();
  ticks(10);
  command_ = [](std::int64_t, msg::JointCommand& command) {
    command.mode = msg::kServoTorque;
    command.torque_nm[0] = command.torque_nm[22] = 6.0;
    return true;
  };
  double furthest_rad = 0.0, most_in_a_tick_rad = 0.0;
  for (int i = 0; i < 150; ++i) {
    const double before_rad = true_angle_rad(0);
    ticks(1);
    furthest_rad = std::max({furthest_rad, true_angle_rad(0), true_angle_rad(22)});
    most_in_a_tick_rad = std::max(most_in_a_tick_rad, true_angle_rad(0) - before_rad);
  }
  EXPECT_LT(furthest_rad, kLimit_rad + 0.02);
  EXPECT_GT(furthest_rad, kLimit_rad - 0.1) << "the torque is strong enough to get there";
  EXPECT_LT(most_in_a_tick_rad, 1.5 * 4.0 * 0.02);
}

TEST_F(DrivenRobot, WithoutCommandsTheTorquesEndAndThePostureIsHeld) {
  start();
  ticks(10);
  command_ = push(2, 1.5);
  ticks(12);
  command_ = nullptr;
  ticks(8);
  EXPECT_EQ(mode(), GateMode::kHolding);
  const auto held = posture();
  ticks(60);
  EXPECT_LT(moved_rad(held), 0.02);
  EXPECT_EQ(torques_on(), 23);
}

TEST_F(DrivenRobot, AnAngleAfterTorquesIsReachedFromWhereTheJointIs) {
  start();
  ticks(10);
  command_ = push(2, 1.5);
  ticks(15);
  ASSERT_GT(true_angle_rad(2), 0.1);
  command_ = bend(0.0);
  for (int i = 0; i < 40; ++i) {
    const double before_rad = true_angle_rad(2);
    ticks(1);
    EXPECT_LT(std::abs(true_angle_rad(2) - before_rad), 1.5 * 4.0 * 0.02) << "tick " << i;
  }
  ticks(40);
  EXPECT_NEAR(true_angle_rad(2), 0.0, 0.03);
  EXPECT_EQ(bench_.robot->servo(2).get("profile_velocity"), 20) << "the profile is in force again";
}

TEST_F(DrivenRobot, AStopEndsTorquesAndHolds) {
  start();
  ticks(10);
  command_ = push(2, 1.5);
  ticks(12);
  order_stop();
  ticks(10);
  EXPECT_EQ(mode(), GateMode::kStopped);
  const auto stopped = posture();
  ticks(50);
  EXPECT_LT(moved_rad(stopped), 0.02);
}

TEST_F(DrivenRobot, AServoWhoseBusIsSilentDoesNotPushOn) {
  start();
  ticks(10);
  command_ = push(2, 1.5);
  ticks(8);
  const double before_rad = true_angle_rad(2);
  bench_.pass_until(bench_.now_ns + 3'000'000'000);  // the driver is gone
  EXPECT_EQ(bench_.robot->servo(2).get("bus_watchdog"), -1);
  EXPECT_LT(std::abs(true_angle_rad(2) - before_rad), 4.0 * 0.02 + 0.01) << "it ends at the last goal";
}

TEST_F(DrivenRobot, RelaxedJointsMayBePushedAndRelaxedAgain) {
  start_relaxed();
  const double before_rad = true_angle_rad(2);
  const auto relaxed = command_;
  command_ = push(2, 1.5);
  ticks(15);
  EXPECT_EQ(torques_on(), 23);
  EXPECT_GT(true_angle_rad(2), before_rad + 0.05);
  command_ = relaxed;
  ticks(10);
  EXPECT_EQ(torques_on(), 0);
}

}  // namespace
}  // namespace constrictor
