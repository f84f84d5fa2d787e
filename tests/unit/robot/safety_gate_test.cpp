// Messages, limits, silence and stops at the safety gate. Authority is tested in safety_gate_authority_test.cpp.
#include <cmath>
#include <functional>
#include <random>

#include "safety_gate_fixture.hpp"

namespace constrictor {
namespace {

TEST_F(SafetyGateTest, HoldsTheMeasuredPostureBeforeTheFirstCommand) {
  const auto& setpoints = tick();
  EXPECT_EQ(state_.mode, GateMode::kHolding);
  EXPECT_EQ(setpoints[0].position_rad, 0.25);
  EXPECT_EQ(setpoints[0].torque_limit_nm, 6.0);
}

TEST_F(SafetyGateTest, FirstCommandStartsAtTheMeasuredPosture) {
  EXPECT_EQ(offer({1.0, -0.25}), GateRefusal::kNone);
  const auto& setpoints = tick();
  EXPECT_EQ(state_.mode, GateMode::kObeying);
  EXPECT_NEAR(setpoints[0].position_rad, 0.25 + kFastest_rad, 1e-8);
  EXPECT_EQ(setpoints[1].position_rad, -0.25);
}

TEST_F(SafetyGateTest, ObeysCommandsWithinTheLimitsExactly) {
  drive_to(0.5, -0.5);
  EXPECT_EQ(offer({0.51, -0.52}, {1.5, 6.0}), GateRefusal::kNone);
  const auto& setpoints = tick();
  EXPECT_EQ(setpoints[0].position_rad, 0.51);
  EXPECT_EQ(setpoints[1].position_rad, -0.52);
  EXPECT_EQ(setpoints[0].torque_limit_nm, 1.5);
}

TEST_F(SafetyGateTest, LimitsRateAndTorque) {
  drive_to(0.0, 0.0);
  velocity_ = -99.0;
  offer({1.0, -1.0}, {50.0, 1.0});
  const auto& setpoints = tick();
  EXPECT_NEAR(setpoints[0].position_rad, kFastest_rad, 1e-8);
  EXPECT_NEAR(setpoints[1].position_rad, -kFastest_rad, 1e-8);
  EXPECT_EQ(setpoints[0].velocity_rad_s, -4.0);
  EXPECT_EQ(setpoints[0].torque_limit_nm, 6.0);
}

// Each rule by itself: the whole message is refused and counted under its own reason, and the joints hold.
TEST_F(SafetyGateTest, RefusesTheWholeMessageAndCountsByReason) {
  struct Case {
    GateRefusal reason;
    std::function<GateRefusal()> offer;
  };
  const std::vector<Case> cases = {
      {GateRefusal::kWrongEpoch,
       [&] {
         run_epoch_ = 1;
         const auto r = offer({0.0, 0.0});
         run_epoch_ = 2;
         return r;
       }},
      {GateRefusal::kFromFuture,
       [&] {
         return offer({0.0, 0.0}, {5, 5}, -1);
       }},
      {GateRefusal::kStale,
       [&] {
         return offer({0.0, 0.0}, {5, 5}, 4);
       }},
      {GateRefusal::kUnknownMode,
       [&] {
         return offer({0.0, 0.0}, {5, 5}, 1, 3);
       }},
      {GateRefusal::kWrongCount,
       [&] {
         return offer({0.0, 0.0, 0.0}, {1, 1, 1});
       }},
      {GateRefusal::kWrongCount,
       [&] {
         return offer({0.0, 0.0}, {1});
       }},
      {GateRefusal::kWrongCount, [&] { return offer({}, {}); }},
      {GateRefusal::kNotFinite,
       [&] {
         return offer({0.0, kNan});
       }},
      {GateRefusal::kNotFinite,
       [&] {
         return offer({0.0, 0.0}, {kInfinity, 1});
       }},
      {GateRefusal::kNotFinite,
       [&] {
         velocity_ = kInfinity;
         const auto r = offer({0.0, 0.0});
         velocity_ = 0;
         return r;
       }},
      {GateRefusal::kBeyondLimits,
       [&] {
         return offer({3.0, 0.0});
       }},
      {GateRefusal::kBeyondLimits,
       [&] {
         return offer({0.0, -3.0});
       }},
      {GateRefusal::kBeyondLimits,
       [&] {
         return offer({0.0, 0.0}, {-0.1, 1});
       }},
  };
  for (std::size_t i = 0; i < cases.size(); ++i) {
    SCOPED_TRACE(i);
    drive_to(0.3, -0.3);
    const auto before = state_.refused;
    EXPECT_EQ(cases[i].offer(), cases[i].reason) << text_of(cases[i].reason);
    const auto& setpoints = tick();
    EXPECT_EQ(state_.mode, GateMode::kHolding);
    EXPECT_EQ(setpoints[0].position_rad, 0.3);
    for (std::size_t reason = 0; reason < before.size(); ++reason) {
      EXPECT_EQ(state_.refused[reason], before[reason] + (reason == static_cast<std::size_t>(cases[i].reason) ? 1 : 0));
    }
  }
}

TEST_F(SafetyGateTest, RefusesCommandsOfAnotherRun) {
  const std::vector<double> zeros(2, 0.0);
  EXPECT_EQ(gate_.offer({8, 2, now_.tick, 1, 0, zeros, zeros, zeros}, now_, state_), GateRefusal::kWrongEpoch);
}

TEST_F(SafetyGateTest, RefusesAWrongNumberOfRatesAndCountsAllRefusals) {
  const std::vector<double> two(2, 0.0);
  const std::vector<double> three(3, 0.0);
  EXPECT_EQ(gate_.offer({7, 2, now_.tick, 77, 0, two, three, two}, now_, state_), GateRefusal::kWrongCount);
  offer({kNan, 0.0});
  offer({0.0, kNan});
  EXPECT_EQ(refused_count(state_), 3u);
}

TEST_F(SafetyGateTest, CountsAnOldMessageOnceAlthoughItIsOfferedAgain) {
  const std::vector<double> bad{kNan, 0.0};
  const std::vector<double> zeros(2, 0.0);
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(gate_.offer({7, 2, 99, 5, 0, bad, zeros, zeros}, now_, state_), GateRefusal::kNotFinite);
  EXPECT_EQ(refused(GateRefusal::kNotFinite), 1u);
}

TEST_F(SafetyGateTest, ObeysAnAgingCommandUntilItIsStale) {
  const std::vector<double> zeros(2, 0.0);
  const std::vector<double> torques(2, 5.0);
  measured_ = {0.0, 0.0};
  const std::int64_t written = now_.tick;
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(gate_.offer({7, 2, written, 5, 0, zeros, zeros, torques}, now_, state_), GateRefusal::kNone);
    tick();
    EXPECT_EQ(state_.mode, GateMode::kObeying);
  }
  EXPECT_EQ(gate_.offer({7, 2, written, 5, 0, zeros, zeros, torques}, now_, state_), GateRefusal::kStale);
  tick();
  EXPECT_EQ(state_.mode, GateMode::kHolding);
  EXPECT_EQ(refused(GateRefusal::kStale), 0u);
}

TEST_F(SafetyGateTest, HoldsTheLastSetpointWhereTheJointAgreesElseTheMeasuredAngle) {
  drive_to(0.5, 0.5);
  offer({0.5, 0.5}, {1.5, 5.0});
  tick();
  measured_ = {0.46, 0.2};  // one joint yields a little, the other one was pushed away
  tick();
  EXPECT_EQ(state_.setpoints[0].position_rad, 0.5);
  EXPECT_EQ(state_.setpoints[0].torque_limit_nm, 1.5) << "a hold must keep the torque limit of a grasp";
  EXPECT_EQ(state_.setpoints[1].position_rad, 0.2);
  measured_ = {0.0, 0.0};  // a joint that sags under load must not move the setpoint
  tick();
  EXPECT_EQ(state_.setpoints[1].position_rad, 0.2);
}

TEST_F(SafetyGateTest, RelaxesAfterALongSilenceAndLaterObeysFromTheMeasuredPosture) {
  for (int i = 0; i < 10; ++i) tick();
  EXPECT_EQ(state_.mode, GateMode::kHolding);
  EXPECT_EQ(tick()[0].torque_limit_nm, 0.0);
  EXPECT_EQ(state_.mode, GateMode::kRelaxed);
  measured_ = {-0.7, 0.0};
  EXPECT_EQ(tick()[0].position_rad, -0.7);
  offer({0.5, 0.0});
  EXPECT_NEAR(tick()[0].position_rad, -0.7 + kFastest_rad, 1e-8);
  EXPECT_EQ(state_.mode, GateMode::kObeying);
}

TEST_F(SafetyGateTest, RelaxesOnCommand) {
  drive_to(0.5, 0.5);
  offer({0.5, 0.5}, {5, 5}, 1, 1);
  EXPECT_EQ(tick()[1].torque_limit_nm, 0.0);
  EXPECT_EQ(state_.mode, GateMode::kRelaxed);
  measured_ = {0.1, 0.1};
  EXPECT_EQ(tick()[0].position_rad, 0.1) << "without further commands the present posture must be held";
  EXPECT_EQ(state_.setpoints[0].torque_limit_nm, 6.0);
}

TEST_F(SafetyGateTest, EmergencyStopHoldsWhateverIsCommanded) {
  drive_to(0.5, 0.5);
  for (int i = 0; i < 400; ++i) {
    if (i < 200) offer({1.0, -1.0});
    tick(GateOrder::kStop);
    ASSERT_EQ(state_.mode, GateMode::kStopped);
    ASSERT_EQ(state_.setpoints[0].position_rad, 0.5);
  }
  offer({0.5, 0.5});
  tick();
  EXPECT_EQ(state_.mode, GateMode::kObeying);
  EXPECT_EQ(state_.setpoints[0].position_rad, 0.5) << "the end of a stop starts no motion";
}

TEST_F(SafetyGateTest, TextOfARefusalHasTheCountOfItsReason) {
  for (int i = 0; i < 3; ++i) offer({0.0, 0.0}, {5, 5}, 4);
  offer({0.0, kNan});
  EXPECT_EQ(text_of(GateRefusal::kStale, state_), "stale on arrival (3 so far)");
  EXPECT_EQ(text_of(GateRefusal::kNotFinite, state_), "not finite (1 so far)");
}

TEST_F(SafetyGateTest, IgnoresMeasurementsThatAreNotFinite) {
  measured_ = {kNan, 0.4};
  EXPECT_EQ(tick()[0].position_rad, 0.0);
  drive_to(0.5, 0.5);
  measured_ = {kNan, 0.5};
  EXPECT_EQ(tick()[0].position_rad, 0.5);
  for (int i = 0; i < 20; ++i) tick();
  EXPECT_EQ(state_.mode, GateMode::kRelaxed);
  EXPECT_EQ(state_.setpoints[0].position_rad, 0.5);
}

TEST_F(SafetyGateTest, RandomInputsNeverExceedLimitsNorMakeSetpointsJump) {
  constexpr unsigned kSeed = 20261121;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937_64 random(kSeed);
  std::uniform_real_distribution<double> wild(-4.0, 4.0);
  std::vector<double> before = measured_;
  GateMode mode_before = GateMode::kHolding;
  int obeyed = 0;
  std::uint8_t level = 1;
  bool took_over = false;
  for (int i = 0; i < 20000; ++i) {
    std::vector<double> position{wild(random) / 2.5, wild(random) / 2.5};
    std::vector<double> torque{std::abs(wild(random)), wild(random) + 3.8};
    if (random() % 9 == 0) position[random() % 2] = random() % 2 == 0 ? kNan : kInfinity;
    velocity_ = 10.0 * wild(random);
    if (random() % 3 != 0)
      offer(position, torque, static_cast<std::int64_t>(random() % 6) - 1,
            static_cast<std::uint8_t>(random() % 12 == 0));
    for (std::size_t j = 0; j < 2; ++j) {
      const double there = state_.started ? state_.setpoints[j].position_rad : measured_[j];
      measured_[j] += std::clamp(there - measured_[j], -0.05, 0.05);  // a servo that follows
    }
    if (random() % 40 == 0) level = static_cast<std::uint8_t>(random() % 4);
    const bool takes_over = level != 0 && level != state_.level && state_.commanded;
    const auto& setpoints = tick(authority(level, "somebody", random() % 40 == 0));
    took_over = took_over || takes_over;
    const bool from_measured = took_over && state_.mode == GateMode::kObeying;
    if (from_measured) took_over = false;
    obeyed += state_.mode == GateMode::kObeying;
    for (std::size_t j = 0; j < 2; ++j) {
      const JointSetpoint& s = setpoints[j];
      ASSERT_LE(std::abs(s.position_rad), 1.57);
      ASSERT_LE(std::abs(s.velocity_rad_s), 4.0);
      ASSERT_GE(s.torque_limit_nm, 0.0);
      ASSERT_LE(s.torque_limit_nm, 6.0);
      // A setpoint may jump only to the measured angle, or at a takeover one step from there.
      const double jump = std::abs(s.position_rad - before[j]);
      const double from_joint = std::abs(s.position_rad - measured_[j]);
      ASSERT_TRUE((jump <= kFastest_rad + 1e-8 && !from_measured) ||
                  from_joint <= (from_measured ? kFastest_rad + 1e-8 : 0.0))
          << i << " from mode " << static_cast<int>(mode_before);
      before[j] = s.position_rad;
    }
    mode_before = state_.mode;
  }
  EXPECT_GT(obeyed, 2000);
}

}  // namespace
}  // namespace constrictor
