// The safety gate in torque mode.
#include <random>

#include "constrictor/archive.hpp"
#include "unit/robot/safety_gate_fixture.hpp"

namespace constrictor {
namespace {

constexpr std::uint8_t kTorque = 2;

class SafetyGateTorque : public SafetyGateTest {
 protected:
  GateRefusal push(std::vector<double> torque_nm, std::vector<double> limit_nm = {5.0, 5.0}, std::int64_t age = 1) {
    const std::vector<double> zeros(limit_nm.size(), 0.0);
    return gate_.offer({7, run_epoch_, now_.tick - age, ++sequence_, kTorque, position_, zeros, limit_nm, torque_nm},
                       now_, state_);
  }
  std::vector<double> position_{0.0, 0.0};
};

TEST_F(SafetyGateTorque, ATorqueIsAtMostTheLimitOfTheCommandAndOfTheJoint) {
  EXPECT_EQ(push({-1.5, 20.0}, {5.0, 50.0}), GateRefusal::kNone);
  tick();
  EXPECT_EQ(state_.mode, GateMode::kObeying);
  EXPECT_TRUE(state_.setpoints[0].torque_mode);
  EXPECT_EQ(state_.setpoints[0].torque_nm, -1.5);
  EXPECT_EQ(state_.setpoints[1].torque_nm, 6.0) << "the joint's own";
  push({-4.0, 4.0}, {1.5, 0.0});
  tick();
  EXPECT_EQ(state_.setpoints[0].torque_nm, -1.5);
  EXPECT_EQ(state_.setpoints[1].torque_nm, 0.0);
}

TEST_F(SafetyGateTorque, ThePositionsOfACommandDoNotCount) {
  position_ = {9.0, -9.0};
  EXPECT_EQ(push({1.0, 1.0}), GateRefusal::kNone);
  EXPECT_EQ(tick()[0].position_rad, 0.25) << "a hold would begin at the measured angle";
}

TEST_F(SafetyGateTorque, AbsurdCommandsAreRefusedAsAWhole) {
  EXPECT_EQ(push({kNan, 1.0}), GateRefusal::kNotFinite);
  EXPECT_EQ(push({1.0, -kInfinity}), GateRefusal::kNotFinite);
  EXPECT_EQ(push({1.0}), GateRefusal::kWrongCount);
  EXPECT_EQ(push({}), GateRefusal::kWrongCount);
  EXPECT_EQ(push({1.0, 1.0, 1.0}), GateRefusal::kWrongCount);
  EXPECT_EQ(push({1.0, 1.0}, {-1.0, 5.0}), GateRefusal::kBeyondLimits);
  EXPECT_EQ(push({1.0, 1.0}, {5.0, 5.0}, 4), GateRefusal::kStale);
  EXPECT_FALSE(tick()[0].torque_mode);
  EXPECT_EQ(state_.mode, GateMode::kHolding);
  EXPECT_EQ(refused_count(state_), 7u);
}

TEST_F(SafetyGateTorque, APlantWithoutTorqueModeRefusesAndNamesTheReason) {
  gate_ = SafetyGate(two_joints(), {3, 10, false});
  EXPECT_EQ(push({1.0, 1.0}), GateRefusal::kNoTorqueMode);
  EXPECT_NE(text_of(GateRefusal::kNoTorqueMode, state_).find("no torque mode (1 so far)"), std::string::npos);
  EXPECT_EQ(offer({0.1, 0.1}), GateRefusal::kNone);
}

TEST_F(SafetyGateTorque, NothingPushesAJointBeyondItsLimit) {
  struct Case {
    double angle_rad, rate_rad_s, torque_nm, expected_nm;
  };
  // The limit is 1.57 rad. At 1 rad/s a joint moves by 0.02 rad in a tick.
  for (const Case& at : {Case{1.56, 0.0, 2.0, 2.0}, Case{1.57, 0.0, 2.0, 0.0}, Case{1.60, 0.0, 2.0, 0.0},
                         Case{1.60, 0.0, -2.0, -2.0}, Case{1.56, 1.0, 2.0, 0.0}, Case{1.54, 1.0, 2.0, 2.0},
                         Case{1.56, 1.0, -2.0, -2.0}, Case{1.60, -1.0, 2.0, 0.0}}) {
    for (const double side : {1.0, -1.0}) {
      measured_ = {side * at.angle_rad, 0.0};
      rates_ = {side * at.rate_rad_s, 0.0};
      push({side * at.torque_nm, 0.0});
      EXPECT_EQ(tick()[0].torque_nm, side * at.expected_nm)
          << at.torque_nm << " Nm at " << side * at.angle_rad << " rad and " << side * at.rate_rad_s << " rad/s";
    }
  }
}

TEST_F(SafetyGateTorque, NothingAcceleratesAJointBeyondItsMaximumSpeed) {
  struct Case {
    double rate_rad_s, torque_nm, expected_nm;
  };
  for (const Case& at : {Case{2.9, 5.0, 5.0}, Case{3.5, 5.0, 3.0}, Case{3.5, 2.0, 2.0}, Case{4.0, 5.0, 0.0},
                         Case{9.0, 5.0, 0.0}, Case{9.0, -5.0, -5.0}}) {
    for (const double side : {1.0, -1.0}) {
      rates_ = {side * at.rate_rad_s, 0.0};
      push({side * at.torque_nm, 0.0});
      EXPECT_NEAR(tick()[0].torque_nm, side * at.expected_nm, 1e-12)
          << at.torque_nm << " Nm at " << side * at.rate_rad_s << " rad/s";
    }
  }
}

TEST_F(SafetyGateTorque, AJointThatIsNotMeasuredExertsNoTorque) {
  measured_ = {kNan, 0.0};
  rates_ = {0.0, kNan};
  push({1.0, 1.0});
  tick();
  EXPECT_EQ(state_.setpoints[0].torque_nm, 0.0);
  EXPECT_EQ(state_.setpoints[1].torque_nm, 0.0);
}

TEST_F(SafetyGateTorque, AHoldAfterTorquesHoldsTheMeasuredPosture) {
  drive_to(0.5, 0.5);
  push({1.0, -1.0}, {1.5, 5.0});
  tick();
  measured_ = {0.55, -0.4};  // the first one is near its last setpoint, but it is not there
  tick();
  EXPECT_EQ(state_.mode, GateMode::kHolding);
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_FALSE(state_.setpoints[i].torque_mode);
    EXPECT_EQ(state_.setpoints[i].torque_nm, 0.0);
    EXPECT_EQ(state_.setpoints[i].position_rad, measured_[i]);
  }
  EXPECT_EQ(state_.setpoints[0].torque_limit_nm, 1.5);
  measured_ = {0.0, 0.0};
  EXPECT_EQ(tick()[1].position_rad, -0.4) << "a joint that sags must not move the setpoint";
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(state_.mode, GateMode::kRelaxed);
}

TEST_F(SafetyGateTorque, AStopAfterTorquesHoldsTheMeasuredPostureAndEndsWithoutMotion) {
  push({1.0, -1.0});
  tick();
  measured_ = {0.7, -0.4};
  push({1.0, -1.0});
  tick(GateOrder::kStop);
  EXPECT_EQ(state_.mode, GateMode::kStopped);
  EXPECT_EQ(state_.setpoints[0].position_rad, 0.7);
  EXPECT_EQ(state_.setpoints[0].torque_nm, 0.0);
  offer({0.7, -0.4});
  EXPECT_EQ(tick()[0].position_rad, 0.7);
}

TEST_F(SafetyGateTorque, TheFirstAngleAfterTorquesIsOneStepFromTheMeasuredPosture) {
  drive_to(0.5, 0.5);
  for (int i = 0; i < 5; ++i) {
    push({1.0, -1.0});
    tick();
  }
  measured_ = {-0.3, 1.2};
  offer({0.5, 0.5});
  EXPECT_NEAR(tick()[0].position_rad, -0.3 + kFastest_rad, 1e-8);
  EXPECT_NEAR(state_.setpoints[1].position_rad, 1.2 - kFastest_rad, 1e-8);
}

TEST_F(SafetyGateTorque, TorquesMayFollowRelaxedJointsAndATakeover) {
  offer({0.0, 0.0}, {5, 5}, 1, 1);
  tick();
  EXPECT_EQ(state_.mode, GateMode::kRelaxed);
  push({1.0, 1.0});
  EXPECT_EQ(tick(authority(1, "one"))[0].torque_nm, 1.0);
  push({2.0, 2.0});
  EXPECT_EQ(tick(authority(2, "two"))[0].torque_nm, 2.0);
  EXPECT_FALSE(state_.take_over) << "a torque takes over at once";
  tick(authority(0));
  EXPECT_EQ(state_.mode, GateMode::kHolding);
}

TEST_F(SafetyGateTorque, ACheckpointInTheMiddleContinuesEqually) {
  push({1.0, -1.0});
  tick();
  push({1.5, -1.5});
  GateState restored;
  load_bytes(save_bytes(state_), restored);
  const auto& again = gate_.setpoints({measured_, rates_}, GateOrder::kObey, kDt_s, restored);
  const auto& first = tick();
  for (const std::size_t i : {0u, 1u}) {
    EXPECT_EQ(again[i].torque_nm, first[i].torque_nm);
    EXPECT_TRUE(again[i].torque_mode);
  }
  EXPECT_EQ(restored.mode, state_.mode);
}

TEST_F(SafetyGateTorque, RandomCommandsNeverPushBeyondAnyLimit) {
  constexpr unsigned kSeed = 20261123;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> wild(-1.0, 1.0);
  int pushed = 0;
  for (int i = 0; i < 20000; ++i) {
    measured_ = {1.8 * wild(random), 1.8 * wild(random)};
    rates_ = {6.0 * wild(random), 6.0 * wild(random)};
    std::vector<double> torque{12.0 * wild(random), 12.0 * wild(random)};
    const std::vector<double> limit{4.0 + 4.0 * wild(random), 4.0 + 4.0 * wild(random)};
    if (random() % 9 == 0) torque[random() % 2] = random() % 2 == 0 ? kNan : kInfinity;
    if (random() % 5 == 0) offer({wild(random), wild(random)});
    else if (random() % 5 != 0) push(torque, limit);
    const std::vector<JointSetpoint> setpoints = tick(random() % 30 == 0 ? GateOrder::kStop : GateOrder::kObey);
    for (std::size_t j = 0; j < 2; ++j) {
      const JointSetpoint& s = setpoints[j];
      ASSERT_LE(std::abs(s.torque_nm), std::min(6.0, s.torque_limit_nm));
      ASSERT_LE(std::abs(s.position_rad), 1.57);
      ASSERT_TRUE(s.torque_mode || s.torque_nm == 0.0);
      ASSERT_FALSE(std::abs(measured_[j]) >= 1.57 && s.torque_nm * measured_[j] > 0.0) << "pushes beyond the limit";
      ASSERT_FALSE(std::abs(rates_[j]) >= 4.0 && s.torque_nm * rates_[j] > 0.0) << "accelerates at the maximum speed";
      pushed += s.torque_nm != 0.0;
    }
  }
  EXPECT_GT(pushed, 5000);
}

}  // namespace
}  // namespace constrictor
