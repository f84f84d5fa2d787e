// A method that demands torques instead of angles, in control with joints that turn by torques.
#include <gtest/gtest.h>

#include <limits>

#include "control_run.hpp"

namespace constrictor {
namespace {

/// Joints without inertia: the rate is proportional to the torque. With angles they behave as IdealServos.
class ViscousJoints : public testing::PlantBase {
 public:
  ViscousJoints(Wiring& wiring, const Setup&)
      : command_(wiring.latest(topics::kJointCommand)), joints_(wiring.output(topics::kJointState)) {
    state_.joint_count = 23;
  }
  void sample(const Tick&) override { joints_.write(state_); }
  void step(const Tick& tick) override {
    if (!command_) return;
    for (int j = 0; j < 23; ++j) {
      state_.velocity_rad_s[j] = 0.0;
      if (command_->mode == msg::kServoTorque) {
        state_.velocity_rad_s[j] = 0.5 * command_->torque_nm[j];
        state_.position_rad[j] += state_.velocity_rad_s[j] * tick.period_s();
      } else if (command_->torque_limit_nm[j] > 0.0) {
        state_.position_rad[j] = command_->position_rad[j];
      }
    }
  }

 private:
  Latest<msg::JointCommand> command_;
  Output<msg::JointState> joints_;
  msg::JointState state_{};
};

/// Demands 1 Nm of joint 2, too much of joint 4, and no number of joint 6.
class Push : public ControlMethod {
 public:
  std::string_view name() const override { return "push"; }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    setpoints.torque_mode = true;
    setpoints.torque_nm[2] = 1.0;
    setpoints.torque_nm[4] = -50.0;
    setpoints.torque_nm[6] = std::numeric_limits<double>::quiet_NaN();
    setpoints.torque_limit_nm[4] = 2.0;
    // Shows the test what the method receives: the sum of the rates, and of the torques of the last command.
    body.scratch[0] = input.rate_rad_s[2];
    setpoints.torque_nm[8] = 0.1 * input.rate_rad_s[2];
    setpoints.torque_nm[10] = 0.1 * input.exerted_nm[4];
    return {};
  }
};

ComponentFactory control_with_push() {
  return make_control_factory({[]() -> std::unique_ptr<ControlMethod> { return std::make_unique<Push>(); }});
}

LocalRun run_of(const char* then, std::int64_t at_tick) {
  return make_run<ViscousJoints>(
      [=](const Tick& tick, msg::DesiredTrajectory& desired) {
        set_motion(desired, tick.index < at_tick ? "push" : then, tick.index < at_tick ? 1 : 2);
        return true;
      },
      control_with_push());
}

TEST(TorqueMethod, ItsTorquesAreLimitedAndWritten) {
  LocalRun run = run_of("hold", 1000);
  run.advance(10);
  const msg::JointCommand& command = *run.latest(topics::kJointCommand);
  EXPECT_EQ(command.mode, msg::kServoTorque);
  EXPECT_EQ(command.torque_nm[2], 1.0);
  EXPECT_EQ(command.torque_nm[4], -2.0) << "the limit of the method";
  EXPECT_EQ(command.torque_nm[6], 0.0) << "no number, no torque";
  EXPECT_NEAR(command.torque_nm[8], 0.1 * 0.5, 1e-12) << "the method knows the rates";
  EXPECT_NEAR(command.torque_nm[10], 0.1 * -2.0, 1e-12) << "and the torques of its last command";
}

TEST(TorqueMethod, TheNextMethodHoldsTheMeasuredPosture) {
  LocalRun run = run_of("hold", 40);
  run.advance(45);
  const double held_rad = run.latest(topics::kJointState)->position_rad[2];
  EXPECT_GT(held_rad, 0.3);
  EXPECT_EQ(run.latest(topics::kJointCommand)->mode, msg::kServoFollow);
  EXPECT_EQ(run.latest(topics::kJointCommand)->torque_nm[2], 0.0);
  run.advance(50);
  EXPECT_NEAR(run.latest(topics::kJointState)->position_rad[2], held_rad, 1e-9);
}

TEST(TorqueMethod, AMotionAfterTorquesBeginsWhereTheJointsAre) {
  LocalRun run = run_of("bend", 40);  // to the straight posture
  run.advance(40);
  double before_rad = run.latest(topics::kJointState)->position_rad[2];
  for (int i = 0; i < 100; ++i) {
    run.advance(1);
    const double now_rad = run.latest(topics::kJointState)->position_rad[2];
    EXPECT_LT(std::abs(now_rad - before_rad), 4.0 * 0.02) << "tick " << i;
    before_rad = now_rad;
  }
  EXPECT_NEAR(before_rad, 0.0, 0.01);
}

TEST(TorqueMethod, SlidingModeContinuesIdenticallyAfterARestart) {
  const Script script = [](const Tick&, msg::DesiredTrajectory& desired) {
    set_motion(desired, "sliding_mode", 1);
    desired.speed_m_s = 0.63;
    return true;
  };
  LocalRun whole = make_run<ViscousJoints>(script);
  LocalRun broken = make_run<ViscousJoints>(script);
  whole.advance(150);
  EXPECT_EQ(whole.latest(topics::kJointCommand)->mode, msg::kServoTorque);
  EXPECT_NE(whole.latest(topics::kJointCommand)->torque_nm[4], 0.0);
  broken.advance(77);
  broken.restart("control");
  broken.advance(73);
  EXPECT_EQ(whole.output_hashes().at("control"), broken.output_hashes().at("control"));
}

TEST(TorqueMethod, NoTorquePushesAJointBeyondItsLimit) {
  LocalRun run = run_of("hold", 100000);
  run.advance(400);  // joint 4 would be at -8 rad
  EXPECT_EQ(run.latest(topics::kJointCommand)->torque_nm[4], 0.0);
  EXPECT_GT(run.latest(topics::kJointState)->position_rad[4], -1.5 - 4.0 * 0.02);
  EXPECT_EQ(run.latest(topics::kJointCommand)->mode, msg::kServoTorque) << "the other joints go on";
}

}  // namespace
}  // namespace constrictor
