// Which source the safety gate obeys, the posture at which the joints start after a takeover, and its saved state.
#include <cmath>
#include <span>
#include <string>

#include "constrictor/archive.hpp"
#include "safety_gate_fixture.hpp"

namespace constrictor {
namespace {

TEST_F(SafetyGateTest, HoldsThePostureWithoutAuthorityAlthoughCommandsArrive) {
  drive_to(0.5, 0.5);
  for (int i = 0; i < 50; ++i) {
    offer({1.0, 1.0});
    EXPECT_EQ(tick(GateOrder::kHold)[0].position_rad, 0.5);
  }
  EXPECT_EQ(state_.mode, GateMode::kHolding);
}

TEST_F(SafetyGateTest, MissingAuthorityMattersOnlyAfterASourceHasHadIt) {
  EXPECT_EQ(authority(0), GateOrder::kObey);
  EXPECT_EQ(authority(1), GateOrder::kObey);
  EXPECT_EQ(authority(0), GateOrder::kHold);
  EXPECT_EQ(authority(4, "pilot", true), GateOrder::kStop);
  EXPECT_EQ(authority(3), GateOrder::kObey);
}

TEST_F(SafetyGateTest, StopBeforeTheFirstCommandHoldsUntilItIsCleared) {
  EXPECT_EQ(authority(4, "pilot", true), GateOrder::kStop);
  EXPECT_EQ(authority(0), GateOrder::kObey) << "control holds the posture by itself";
}

// A joint under load is not at its setpoint. Every takeover starts at the measured angle, whatever happened before.
TEST_F(SafetyGateTest, TakeOverStartsAtTheMeasuredPosture) {
  struct Holder {
    std::uint8_t level;
    std::string source;
    bool stop = false;
  };
  const Holder planner{1, "planner"}, external{2, "fast"}, pilot{3, "pilot"}, script{3, "script"}, nobody{0, ""},
      stopped{4, "pilot", true};
  const std::vector<std::vector<Holder>> changes = {
      {planner, pilot}, {pilot, planner},           {external, pilot},        {pilot, external},
      {script, pilot},  {planner, nobody, planner}, {pilot, nobody, planner}, {pilot, stopped, nobody, pilot}};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    SCOPED_TRACE(i);
    state_ = {};
    sequence_ = 0;
    authority(changes[i][0].level, changes[i][0].source);
    drive_to(0.5, -0.5);
    measured_ = {0.2, -0.5};  // the first joint sags, the second is at its setpoint
    for (const Holder& holder : std::span(changes[i]).subspan(1)) {
      const GateOrder order = authority(holder.level, holder.source, holder.stop);
      measured_[0] -= 0.01;
      EXPECT_EQ(offer({0.5, -0.5}, {1.5, 5.0}), GateRefusal::kNone);
      tick(order);
    }
    EXPECT_EQ(state_.mode, GateMode::kObeying);
    EXPECT_NEAR(state_.setpoints[0].position_rad, measured_[0] + kFastest_rad, 1e-8);
    EXPECT_EQ(state_.setpoints[1].position_rad, -0.5);
    EXPECT_EQ(state_.setpoints[0].torque_limit_nm, 1.5);
    authority(changes[i].back().level, changes[i].back().source);
    offer({0.5, -0.5});
    EXPECT_NEAR(tick()[0].position_rad, measured_[0] + 2 * kFastest_rad, 1e-8)
        << "one step from the measured angle in each tick";
  }
}

TEST_F(SafetyGateTest, FirstSourceOfARunTakesNothingOver) {
  authority(0);
  drive_to(0.5, 0.5);  // control holds by itself, or the first authority message has not arrived yet
  measured_ = {0.2, 0.2};
  authority(1, "planner");
  offer({0.5, 0.5});
  EXPECT_EQ(tick()[0].position_rad, 0.5);
}

TEST_F(SafetyGateTest, TakeOverWaitsForAnObeyedCommandAndKeepsUnmeasuredJoints) {
  authority(1, "planner");
  drive_to(0.5, 0.5);
  authority(3, "pilot");
  offer({kNan, 0.5});
  EXPECT_EQ(tick()[0].position_rad, 0.5) << "a refused command must not move the joint";
  measured_ = {0.1, kNan};
  offer({0.5, 0.4});
  EXPECT_NEAR(tick()[0].position_rad, 0.1 + kFastest_rad, 1e-8);
  EXPECT_NEAR(state_.setpoints[1].position_rad, 0.5 - kFastest_rad, 1e-8);
  authority(1, "planner");
  measured_ = {1.7, 0.4};  // beyond the stop, as soft contacts allow
  offer({1.5, 0.4});
  EXPECT_NEAR(tick()[0].position_rad, 1.5, 1e-12);
}

// The gate of control in front of the gate of the plant, which gets commands and measured angles one tick later. A
// takeover interrupts a squeeze on a stiff object for a few ticks at most and never without torque. Neither gate lets
// a setpoint jump.
TEST_F(SafetyGateTest, TakeOverThroughBothGatesKeepsASqueeze) {
  const SafetyGate at_control(two_joints(), {0, 250});
  const SafetyGate at_plant(two_joints(), {5, 250});
  GateState control;
  GateState plant;
  const std::vector<double> measured{0.6, 0.6};  // the grasped object stops the joints
  const std::vector<double> wanted{0.9, 0.9};
  const std::vector<double> zeros(2, 0.0);
  const std::vector<double> torques(2, 1.5);
  std::vector<double> sent = measured;
  int interrupted = 0;
  for (std::int64_t now = 0; now < 60; ++now) {
    const std::uint8_t level = now < 30 ? 1 : 3;
    const auto number = static_cast<std::uint64_t>(now) + 1;
    const double before = now == 0 ? 0.6 : plant.setpoints[0].position_rad;
    if (now > 0) {
      EXPECT_EQ(at_plant.offer({7, 2, now - 1, number, 0, sent, zeros, torques}, {7, 2, now}, plant),
                GateRefusal::kNone);
    }
    const double there =
        at_plant.setpoints({measured}, SafetyGate::order_of(false, level, std::string("x"), plant), kDt_s, plant)[0]
            .position_rad;
    at_control.offer({7, 2, now, number, 0, wanted, zeros, torques}, {7, 2, now}, control);
    sent[0] = sent[1] =
        at_control
            .setpoints({measured}, SafetyGate::order_of(false, level, std::string("x"), control), kDt_s, control)[0]
            .position_rad;
    EXPECT_TRUE(std::abs(there - before) <= kFastest_rad + 1e-8 || (now == 30 && there <= 0.6 + kFastest_rad + 1e-8))
        << now;
    if (now < 10) continue;
    if (now == 30) {
      EXPECT_LE(there, 0.6 + kFastest_rad + 1e-8);
    }
    EXPECT_GT(there, 0.6) << "the squeeze must not be interrupted";
    EXPECT_EQ(plant.setpoints[0].torque_limit_nm, 1.5);
    interrupted += there < 0.9 - 1e-6;
  }
  EXPECT_GE(interrupted, 1);
  EXPECT_LE(interrupted, 6);
}

TEST_F(SafetyGateTest, ContinuesIdenticallyFromItsSavedState) {
  drive_to(0.5, 0.2);
  offer({0.9, kNan});
  tick();
  GateState restored;
  load_bytes(save_bytes(state_), restored);
  offer({0.9, 0.9});
  SafetyGate other(two_joints(), {3, 10});
  const std::vector<double> position{0.9, 0.9};
  const std::vector<double> zeros(2, 0.0);
  const std::vector<double> torque(2, 5.0);
  other.offer({7, 2, now_.tick - 1, sequence_, 0, position, zeros, torque}, now_, restored);
  tick();
  const auto& again = other.setpoints({measured_}, GateOrder::kObey, kDt_s, restored);
  EXPECT_EQ(again[0].position_rad, state_.setpoints[0].position_rad);
  EXPECT_EQ(restored.refused, state_.refused);
}

}  // namespace
}  // namespace constrictor
