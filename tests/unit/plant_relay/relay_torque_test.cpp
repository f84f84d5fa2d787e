// plant_relay and commands that demand torques.
#include "relay_rig.hpp"

namespace constrictor {
namespace {

testing::CommandAt push(double torque_nm) {
  return [=](std::int64_t, msg::JointCommand& command) {
    command.mode = msg::kServoTorque;
    command.torque_nm[4] = torque_nm;
    return true;
  };
}

class RelayWithTorques : public Relay {
 protected:
  RelayWithTorques() : Relay("hardware: {patience_s: 1, torque_mode: true}\n") {}
};

TEST_F(Relay, RefusesTorquesUnlessTheHardwareObeysThem) {
  command_ = push(1.0);
  ticks(10);
  EXPECT_EQ(mode(), GateMode::kHolding);
  EXPECT_NE(last_refusal().find("torques demanded of a plant that has no torque mode"), std::string::npos)
      << last_refusal();
  for (const auto& command : sent_) {
    EXPECT_EQ(command.mode, msg::kServoFollow);
    EXPECT_EQ(command.torque_nm[4], 0.0);
  }
}

TEST_F(RelayWithTorques, RelaysTorquesAndTheMeasuredPosture) {
  angles_rad_[4] = 0.3;
  command_ = push(-9.0);
  ticks(10);
  EXPECT_EQ(sent_.back().mode, msg::kServoTorque);
  EXPECT_EQ(sent_.back().torque_nm[4], -6.0) << "the joint's own limit";
  EXPECT_EQ(sent_.back().torque_nm[5], 0.0);
  EXPECT_NEAR(sent_.back().position_rad[4], 0.3, 1e-9);
}

TEST_F(RelayWithTorques, AJointThatATorqueDoesNotMoveIsNotFrozen) {
  follows_ = false;
  command_ = push(1.0);
  ticks(100);
  EXPECT_EQ(mode(), GateMode::kObeying);
  EXPECT_TRUE(relay().state().obstacle.empty()) << relay().state().obstacle;
}

TEST_F(RelayWithTorques, AFaultOfTheHardwareEndsTheTorquesAndHolds) {
  command_ = push(1.0);
  ticks(10);
  damage_ = [](msg::HardwareJointState& state) { set_text(state.fault, "no torque mode"); };
  ticks(5);
  EXPECT_EQ(sent_.back().mode, msg::kServoFollow);
  EXPECT_NE(last_refusal().find("fault: no torque mode"), std::string::npos) << last_refusal();
}

}  // namespace
}  // namespace constrictor
