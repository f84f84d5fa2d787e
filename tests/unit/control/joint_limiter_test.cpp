#include "control/joint_limiter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "component/data_path.hpp"

namespace constrictor {
namespace {

class JointLimiterTest : public ::testing::Test {
 protected:
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  static constexpr double kLead_s = 0.04;
  JointLimiter limiter{robot, 1.0, kLead_s};

  /// [rad] The farthest setpoint ahead of a joint that does not move.
  static double lead_rad(const JointModel& joint, double torque_limit_nm) {
    return torque_limit_nm / joint.position_gain_nm_rad + joint.max_speed_rad_s * kLead_s;
  }
};

TEST_F(JointLimiterTest, FirstSetpointStartsAtTheMeasuredPosture) {
  LimiterState state;
  JointArray measured{};
  for (std::size_t j = 0; j < robot.joints.size(); ++j) measured[j] = 0.3 * std::sin(static_cast<double>(j));
  const auto command = limiter.limit(Setpoints{}, measured, 0.02, state);
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    EXPECT_LE(std::abs(command.position_rad[j] - measured[j]), robot.joints[j].max_speed_rad_s * 0.02 + 1e-12);
  }
}

TEST_F(JointLimiterTest, RandomSetpointsNeverExceedTheLimitsOfTheRobot) {
  constexpr unsigned kSeed = 20261121;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  std::uniform_real_distribution<double> wild(-20.0, 20.0);
  LimiterState state;
  JointArray previous{};  // the joints follow at once
  for (int step = 0; step < 2000; ++step) {
    Setpoints wanted;
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      wanted.position_rad[j] = wild(random);
      wanted.torque_limit_nm[j] = wild(random);
      if (step % 7 == 0 && j % 5 == 0) wanted.position_rad[j] = std::numeric_limits<double>::quiet_NaN();
      if (step % 11 == 0 && j % 3 == 0) wanted.torque_limit_nm[j] = std::numeric_limits<double>::infinity();
    }
    const auto command = limiter.limit(wanted, previous, 0.02, state);
    ASSERT_EQ(command.joint_count, robot.joints.size());
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      const JointModel& joint = robot.joints[j];
      ASSERT_TRUE(std::isfinite(command.position_rad[j]));
      ASSERT_GE(command.position_rad[j], joint.min_rad);
      ASSERT_LE(command.position_rad[j], joint.max_rad);
      ASSERT_LE(std::abs(command.position_rad[j] - previous[j]), joint.max_speed_rad_s * 0.02 + 1e-12);
      ASSERT_LE(std::abs(command.velocity_rad_s[j]), joint.max_speed_rad_s + 1e-9);
      ASSERT_GE(command.torque_limit_nm[j], 0.0);
      ASSERT_LE(command.torque_limit_nm[j], joint.max_torque_nm);
      previous[j] = command.position_rad[j];
    }
  }
}

TEST_F(JointLimiterTest, AJointKeptAwayFromItsSetpointDoesNotJumpWhenItsTorqueLimitRises) {
  constexpr double kWeak_nm = 1.5;
  LimiterState state;
  Setpoints wanted;
  wanted.position_rad[4] = 0.8;  // an object keeps the joint at 0
  wanted.torque_limit_nm[4] = kWeak_nm;
  for (int tick = 0; tick < 50; ++tick) limiter.limit(wanted, {}, 0.02, state);
  const JointModel& joint = robot.joints[4];
  ASSERT_NEAR(state.position_rad[4], lead_rad(joint, kWeak_nm), 1e-12);
  wanted.torque_limit_nm[4] = joint.max_torque_nm;
  double previous_rad = state.position_rad[4];
  for (int tick = 0; tick < 50; ++tick) {
    const auto command = limiter.limit(wanted, {}, 0.02, state);
    ASSERT_LE(std::abs(command.position_rad[4] - previous_rad), joint.max_speed_rad_s * 0.02 + 1e-12);
    previous_rad = command.position_rad[4];
    if (command.torque_limit_nm[4] > kWeak_nm) {
      EXPECT_LE(command.position_rad[4], 0.1 + joint.max_speed_rad_s * 0.02);
      EXPECT_GE(command.position_rad[4], kWeak_nm / joint.position_gain_nm_rad);
      return;
    }
  }
  ADD_FAILURE() << "the limit did not rise";
}

TEST_F(JointLimiterTest, TheSetpointOfABlockedJointWaitsForItAndTheTorqueIsComplete) {
  const JointModel& joint = robot.joints[4];
  LimiterState state;
  Setpoints wanted;
  JointArray measured{};
  wanted.position_rad[4] = -1.2;  // something keeps the joint at 0
  wanted.torque_limit_nm[4] = joint.max_torque_nm;
  for (int tick = 0; tick < 100; ++tick) limiter.limit(wanted, measured, 0.02, state);
  EXPECT_NEAR(state.position_rad[4], -lead_rad(joint, joint.max_torque_nm), 1e-12);
  EXPECT_GE(joint.position_gain_nm_rad * -state.position_rad[4], joint.max_torque_nm);

  // It comes free, and follows its setpoint within the tick: both arrive, and no setpoint jumps.
  for (int tick = 0; tick < 100; ++tick) {
    const double before_rad = measured[4] = state.position_rad[4];
    limiter.limit(wanted, measured, 0.02, state);
    ASSERT_LE(std::abs(state.position_rad[4] - before_rad), joint.max_speed_rad_s * 0.02 + 1e-12);
  }
  EXPECT_NEAR(state.position_rad[4], -1.2, 1e-12);
}

TEST_F(JointLimiterTest, TheSetpointOfABlockedElasticJointStretchesItsSpring) {
  robot = load_robot(data_path("components/lib/robot/serpens.yaml"));
  const JointModel& joint = robot.joints[4];
  ASSERT_GT(joint.stiffness_nm_rad, 0.0);
  LimiterState state;
  Setpoints wanted;
  wanted.position_rad[4] = 1.2;
  wanted.torque_limit_nm[4] = joint.max_torque_nm;
  for (int tick = 0; tick < 100; ++tick) limiter.limit(wanted, {}, 0.02, state);
  EXPECT_NEAR(state.position_rad[4],
              lead_rad(joint, joint.max_torque_nm) + joint.max_torque_nm / joint.stiffness_nm_rad, 1e-12);
}

TEST_F(JointLimiterTest, AMeasurementThatIsNotFiniteBoundsNoSetpoint) {
  LimiterState state;
  Setpoints wanted;
  JointArray measured{};
  limiter.limit(wanted, measured, 0.02, state);
  measured[4] = std::numeric_limits<double>::quiet_NaN();
  wanted.position_rad[4] = 0.8;
  for (int tick = 0; tick < 50; ++tick) limiter.limit(wanted, measured, 0.02, state);
  EXPECT_NEAR(state.position_rad[4], 0.8, 1e-12);
}

TEST_F(JointLimiterTest, AJointThatFollowsItsSetpointGetsItsTorqueAtOnce) {
  LimiterState state;
  Setpoints wanted;
  JointArray measured{};
  wanted.position_rad[4] = measured[4] = 0.05;
  wanted.torque_limit_nm[4] = 1.5;
  limiter.limit(wanted, measured, 0.02, state);
  wanted.torque_limit_nm[4] = 5.0;
  EXPECT_EQ(limiter.limit(wanted, measured, 0.02, state).torque_limit_nm[4], 5.0);
}

TEST_F(JointLimiterTest, VelocityIsTheRateOfTheSetpoint) {
  LimiterState state;
  Setpoints wanted;
  limiter.limit(wanted, {}, 0.02, state);
  wanted.position_rad[4] = 0.01;
  EXPECT_NEAR(limiter.limit(wanted, {}, 0.02, state).velocity_rad_s[4], 0.5, 1e-12);
}

TEST_F(JointLimiterTest, RelaxedJointsHaveNoTorqueAndAreLaterHeldWhereTheyAre) {
  LimiterState state;
  limiter.limit(Setpoints{}, {}, 0.02, state);
  JointArray measured{};
  measured[2] = 0.7;
  const auto command = limiter.relax(measured, state);
  EXPECT_EQ(command.torque_limit_nm[2], 0.0);
  Setpoints wanted;
  wanted.position_rad[2] = 0.7;
  EXPECT_NEAR(limiter.limit(wanted, measured, 0.02, state).position_rad[2], 0.7, 1e-12);
}

}  // namespace
}  // namespace constrictor
