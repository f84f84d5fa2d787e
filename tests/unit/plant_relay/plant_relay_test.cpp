// plant_relay with hardware that the test plays: posture first, refusals, loss and return, stops.
#include "relay_rig.hpp"

namespace constrictor {
namespace {

TEST_F(Relay, SendsNothingBeforeThePostureIsKnownAndThenThisPosture) {
  alive_ = false;
  command_ = bend(0.5);
  ticks(20);
  EXPECT_TRUE(sent_.empty());
  EXPECT_EQ(run_->latest(topics::kJointState), nullptr);
  alive_ = true;
  angles_rad_[4] = -0.3;
  ticks(3);
  ASSERT_EQ(sent_.size(), 1u);
  EXPECT_NEAR(sent_[0].position_rad[4], -0.3, 4.0 * 0.02 + 1e-6) << "no faster than the joint can move";
  EXPECT_NE(sent_[0].session, 0u);
  EXPECT_EQ(sent_[0].sequence_number, 1u);
  EXPECT_EQ(sent_[0].period_ns, kPeriod_ns);
  EXPECT_EQ(sent_[0].joint_count, kJoints);
  EXPECT_DOUBLE_EQ(run_->latest(topics::kJointState)->position_rad[4], -0.3);
}

TEST_F(Relay, RelaysCommandsAndMeasurements) {
  command_ = bend(0.5);
  ticks(30);
  EXPECT_EQ(mode(), GateMode::kObeying);
  EXPECT_DOUBLE_EQ(sent_.back().position_rad[4], 0.5);
  EXPECT_DOUBLE_EQ(sent_.back().torque_limit_nm[4], 6.0);
  EXPECT_DOUBLE_EQ(run_->latest(topics::kJointState)->position_rad[4], 0.5);
  for (std::size_t i = 1; i < sent_.size(); ++i) EXPECT_EQ(sent_[i].sequence_number, sent_[i - 1].sequence_number + 1);
}

TEST_F(Relay, EndsTheRunIfNoPostureArrivesInTime) {
  alive_ = false;
  try {
    ticks(60);
    FAIL() << "the run goes on without hardware";
  } catch (const ConfigurationError& error) {
    EXPECT_NE(std::string(error.what()).find("hardware/joint_state: found no acceptable sample within 1 s"),
              std::string::npos)
        << error.what();
  }
}

struct Wrong {
  const char* name;
  std::function<void(msg::HardwareJointState&)> damage;
  const char* reason;
};

class RelayRefuses : public Relay, public ::testing::WithParamInterface<Wrong> {};

TEST_P(RelayRefuses, AndHoldsUntilTheSamplesAreRightAgain) {
  command_ = bend(0.5);
  ticks(30);
  damage_ = GetParam().damage;
  ticks(4);
  EXPECT_NE(last_refusal().find(GetParam().reason), std::string::npos) << last_refusal();
  ticks(10);
  EXPECT_FALSE(relay().state().following);
  EXPECT_NE(last_refusal().find(GetParam().reason), std::string::npos) << last_refusal();
  const std::size_t commands = sent_.size();
  ticks(10);
  EXPECT_EQ(sent_.size(), commands) << "the hardware holds by itself";
  EXPECT_DOUBLE_EQ(run_->latest(topics::kJointState)->position_rad[4], 0.5);
  damage_ = nullptr;
  ticks(30);
  EXPECT_EQ(mode(), GateMode::kObeying);
}

INSTANTIATE_TEST_SUITE_P(
    Samples, RelayRefuses,
    ::testing::Values(
        Wrong{"Count", [](auto& s) { s.joint_count = 22; }, "joint_count: found 22, accepted 23"},
        Wrong{"Session", [](auto& s) { s.session = 0; }, "session: found 0"},
        Wrong{"Number", [](auto& s) { s.sequence_number = 3; }, "sequence_number: found 3"},
        Wrong{"Stamp", [](auto& s) { s.time_ns = 7; }, "time_ns: found 7"},
        Wrong{"Degrees", [](auto& s) { s.position_rad[4] *= 57.3; }, "unit, zero or sign of the joint is wrong"},
        Wrong{"Jump", [](auto& s) { s.position_rad[9] = s.sequence_number % 2 ? 1.2 : -1.2; }, "found a jump by"},
        Wrong{"Torque", [](auto& s) { s.torque_nm[2] = 6000.0; }, "torque_nm[2]: found 6000"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_F(Relay, GoesOnFromWhereTheJointsAreAfterALoss) {
  command_ = [](std::int64_t, msg::JointCommand&) { return false; };  // no commands arrive: the posture is held
  ticks(20);
  alive_ = false;
  ticks(20);
  EXPECT_FALSE(relay().state().following);
  EXPECT_NE(last_refusal().find("hardware: lost"), std::string::npos) << last_refusal();
  // A person has bent a joint by hand, and the process was started again.
  angles_rad_[4] = 0.7;
  follows_ = false;
  session_ = 78;
  number_ = 0;
  time_ns_ = 5;
  alive_ = true;
  const std::size_t before = sent_.size();
  ticks(5);
  ASSERT_GT(sent_.size(), before);
  EXPECT_DOUBLE_EQ(sent_[before].position_rad[4], 0.7) << "a hold of the old posture would move the joint";
  EXPECT_DOUBLE_EQ(sent_.back().position_rad[4], 0.7);
}

TEST_F(Relay, RefusesASecondProcessWhileTheFirstOneWrites) {
  command_ = bend(0.5);
  ticks(20);
  msg::HardwareJointState other = measured();
  other.session = 99;
  other.position_rad[4] = 0.4;
  link().add(other);
  ticks(1);
  EXPECT_NE(last_refusal().find("two processes write"), std::string::npos) << last_refusal();
  EXPECT_EQ(relay().state().hardware.session, 77u);
  EXPECT_EQ(mode(), GateMode::kObeying);
}

TEST_F(Relay, HoldsWhileTheHardwareConfirmsNoCommand) {
  hears_ = false;
  follows_ = false;
  command_ = bend(0.5);
  ticks(30);
  EXPECT_NE(last_refusal().find("hardware: confirms no command"), std::string::npos) << last_refusal();
  EXPECT_EQ(mode(), GateMode::kHolding);
  hears_ = follows_ = true;
  ticks(30);
  EXPECT_EQ(mode(), GateMode::kObeying);
  EXPECT_DOUBLE_EQ(sent_.back().position_rad[4], 0.5);
}

TEST_F(Relay, HoldsWhileTheHardwareReportsAFault) {
  command_ = bend(0.5);
  ticks(20);
  damage_ = [](msg::HardwareJointState& state) { set_text(state.fault, "bus power is low"); };
  ticks(3);
  EXPECT_EQ(mode(), GateMode::kHolding);
  EXPECT_NE(last_refusal().find("bus power is low"), std::string::npos) << last_refusal();
  damage_ = nullptr;
  ticks(3);
  EXPECT_EQ(mode(), GateMode::kObeying);
}

TEST_F(Relay, StopsWhenTheMeasurementsAreFrozen) {
  ticks(10);
  follows_ = false;
  command_ = bend(0.5);
  ticks(60);
  EXPECT_NE(last_refusal().find("hardware: is frozen"), std::string::npos) << last_refusal();
  EXPECT_EQ(mode(), GateMode::kStopped);
  EXPECT_STREQ(run_->latest(topics::kStopState)->source, "hardware_frozen");
  EXPECT_LT(sent_.back().position_rad[4], 0.1) << "the posture is held where it was measured";
}

TEST_F(Relay, AnEmergencyStopHoldsThePosture) {
  command_ = bend(0.5);
  ticks(4);
  run_->member("plant_relay").stop_orders()->add("somebody");
  ticks(2);
  EXPECT_EQ(mode(), GateMode::kStopped);
  const double held_rad = sent_.back().position_rad[4];
  EXPECT_LT(held_rad, 0.45);
  ticks(30);
  EXPECT_DOUBLE_EQ(sent_.back().position_rad[4], held_rad);
}

TEST_F(Relay, ShowsContactsAndInertialUnitOfTheHardware) {
  ticks(5);
  msg::HardwareContactState contacts{};
  contacts.session = session_;
  contacts.sequence_number = 1;
  contacts.module_count = 24;
  contacts.force_n[3].z = 2.5;
  msg::HardwareImuState imu{};
  imu.session = session_;
  imu.sequence_number = 1;
  imu.orientation.w = 1.0;
  imu.linear_acceleration_m_s2.z = 9.8;
  link().add(contacts);
  link().add(imu);
  ticks(1);
  EXPECT_EQ(run_->latest(topics::kContactState)->module_count, 24);
  EXPECT_DOUBLE_EQ(run_->latest(topics::kContactState)->force_n[3].z, 2.5);
  EXPECT_DOUBLE_EQ(run_->latest(topics::kImuState)->linear_acceleration_m_s2.z, 9.8);
  contacts.sequence_number = 2;
  contacts.module_count = 7;
  link().add(contacts);
  imu.sequence_number = 2;
  imu.orientation.w = 0.3;
  link().add(imu);
  ticks(1);
  EXPECT_EQ(run_->latest(topics::kContactState)->module_count, 0) << "the sample was refused";
  EXPECT_NE(last_refusal().find("a quaternion of length 0.300"), std::string::npos) << last_refusal();
}

TEST_F(Relay, BeginsANewSessionAfterAReset) {
  command_ = bend(0.5);
  ticks(10);
  const std::uint64_t before = sent_.back().session;
  run_->reset(2);
  ticks(10);
  EXPECT_NE(sent_.back().session, before);
  EXPECT_LE(sent_.back().sequence_number, 10u);
  EXPECT_EQ(mode(), GateMode::kObeying);
}

}  // namespace
}  // namespace constrictor
