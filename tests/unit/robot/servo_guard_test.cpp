#include "robot/servo_guard.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace constrictor {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class ServoGuardTest : public testing::Test {
 protected:
  static RobotModel two_joints() {
    RobotModel robot;
    robot.module_count = 3;
    robot.joints.resize(2);
    return robot;
  }
  /// One tick in which a command of this age arrives.
  const std::vector<JointSetpoint>& tick(std::int64_t age, std::vector<double> position,
                                         std::vector<double> torque = {5.0, 5.0}) {
    reason_ = guard_.offer(age, position, std::vector<double>(position.size(), 0.0), torque);
    return guard_.setpoints(measured_);
  }
  const std::vector<JointSetpoint>& silent_tick() { return guard_.setpoints(measured_); }

  ServoGuard guard_{two_joints(), {3, 10}};
  std::vector<double> measured_{0.25, -0.25};
  std::string_view reason_;
};

TEST_F(ServoGuardTest, ObeysAnAcceptableCommand) {
  const auto& setpoints = tick(1, {0.5, -0.5});
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kObeying);
  EXPECT_EQ(setpoints[1].position_rad, -0.5);
  EXPECT_EQ(setpoints[1].torque_limit_nm, 5.0);
}

TEST_F(ServoGuardTest, HoldsTheMeasuredPostureBeforeTheFirstCommand) {
  const auto& setpoints = silent_tick();
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kHolding);
  EXPECT_EQ(setpoints[0].position_rad, 0.25);
  EXPECT_EQ(setpoints[0].torque_limit_nm, 6.0);
}

TEST_F(ServoGuardTest, HoldsThePostureOfTheMomentWhenTheCommandGoesStale) {
  tick(1, {0.5, 0.5});
  measured_ = {0.4, 0.4};
  tick(4, {0.9, 0.9});
  EXPECT_EQ(reason_, "stale");
  measured_ = {0.1, 0.1};  // sagging under load must not move the setpoint
  EXPECT_EQ(silent_tick()[0].position_rad, 0.4);
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kHolding);
}

TEST_F(ServoGuardTest, RelaxesAfterALongSilenceAndObeysAgain) {
  for (int i = 0; i < 10; ++i) silent_tick();
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kHolding);
  EXPECT_EQ(silent_tick()[0].torque_limit_nm, 0.0);
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kRelaxed);
  EXPECT_EQ(tick(1, {0.5, 0.5})[0].position_rad, 0.5);
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kObeying);
}

TEST_F(ServoGuardTest, RefusesAsAWholeWhatIsNotANumber) {
  const auto& setpoints = tick(1, {0.5, kNan});
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kHolding);
  EXPECT_EQ(setpoints[0].position_rad, 0.25);
  EXPECT_EQ(guard_.refused(), 1U);
}

TEST_F(ServoGuardTest, RefusesTheWrongNumberOfJoints) {
  tick(1, {0.5, 0.5, 0.5}, {1, 1, 1});
  EXPECT_EQ(reason_, "wrong number of joints");
  tick(1, {}, {});
  EXPECT_EQ(guard_.refused(), 2U);
  EXPECT_EQ(guard_.mode(), ServoGuard::Mode::kHolding);
}

TEST_F(ServoGuardTest, RefusesWhatIsBeyondTheLimitsAndClampsTheTorque) {
  tick(1, {3.0, 0.0});
  EXPECT_EQ(guard_.refused(), 1U);
  EXPECT_EQ(tick(1, {0.0, 0.0}, {50.0, 1.5})[0].torque_limit_nm, 6.0);
  EXPECT_EQ(tick(1, {0.0, 0.0}, {50.0, 1.5})[1].torque_limit_nm, 1.5);
}

}  // namespace
}  // namespace constrictor
