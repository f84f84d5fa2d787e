// The method obstacle_aided, compared with the statics of a body that slides along itself.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "unit/control/control_run.hpp"

namespace constrictor {
namespace {

/// The method without the component around it.
class Steps {
 public:
  Steps() {
    desired_.speed_m_s = 0.45;
    felt.module_count = 24;
    imu.orientation.w = 1.0;
  }
  /// A step with these angles of the yaw joints.
  Setpoints step(const LinkArray& yaw_rad) {
    JointArray angle_rad{};
    for (std::size_t k = 0; k < chain.joint_count(); ++k) angle_rad[chain.joint_index(k)] = yaw_rad[k];
    const Gait gait = gait_of(desired_, config_);
    const MethodInput input{robot, chain, config_, desired_, gait, angle_rad, {}, {}, 0.02, {&felt, &imu}, {}, {}};
    if (!started_) method_->start(input, body);
    started_ = true;
    Setpoints setpoints;
    for (std::size_t j = 0; j < robot.joints.size(); ++j) setpoints.torque_limit_nm[j] = robot.joints[j].max_torque_nm;
    method_->step(input, body, setpoints);
    return setpoints;
  }
  /// The same, `count` times. Returns the last setpoints.
  Setpoints steps(const LinkArray& yaw_rad, int count) {
    for (int i = 1; i < count; ++i) step(yaw_rad);
    return step(yaw_rad);
  }
  /// A force [N] on a module, in its frame.
  void touch(int module, double x_n, double y_n) {
    msg::Contact& contact = felt.contacts[felt.contact_count++];
    contact.module_index = static_cast<std::uint8_t>(module);
    contact.force_n = {x_n, y_n, 0.0};
    const double force_n = std::hypot(x_n, y_n);
    contact.normal = {x_n / force_n, y_n / force_n, 0.0};
  }

  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  YawChain chain{robot};
  msg::ContactState felt{};
  msg::ImuState imu{};
  BodyState body;

 private:
  MethodRegistry registry_;
  ControlConfig config_;
  const ControlMethod* method_ = registry_.find("obstacle_aided");
  msg::DesiredTrajectory desired_{};
  bool started_ = false;
};

LinkArray wave(double amplitude_rad, double phase_rad) {
  LinkArray angle_rad{};
  for (std::size_t k = 0; k < 12; ++k)
    angle_rad[k] = amplitude_rad * std::sin(phase_rad - 2.0 * std::numbers::pi * static_cast<double>(k) / 6.0);
  return angle_rad;
}

/// The torque that a servo exerts when its setpoint is so far ahead that the limit decides.
double torque_nm(const Steps& steps, const Setpoints& setpoints, const LinkArray& angle_rad, std::size_t k) {
  const std::size_t j = steps.chain.joint_index(k);
  const double spring_nm = steps.robot.joints[j].position_gain_nm_rad * (setpoints.position_rad[j] - angle_rad[k]);
  const double limit_nm = setpoints.torque_limit_nm[j];
  return std::clamp(spring_nm, -limit_nm, limit_nm);
}

// Virtual work: pegs without friction on both flanks of a bent body do no work while it slides along itself. The work
// of the joints is therefore that of the force by which the pegs propel the body.
TEST(ObstacleAided, TorquesPropelABodyThatPegsHoldOnItsPath) {
  for (int i = 0; i < 8; ++i) {
    Steps steps;
    const double ground_n = 0.4 * 9.81 * 24 * steps.robot.module_mass_kg;
    const LinkArray angle_rad = wave(0.8, 0.8 * i);
    const Setpoints setpoints = steps.steps(angle_rad, 120);
    double force_n = 0.0;
    for (std::size_t k = 1; k < 12; ++k) {
      // A body that slid forwards by one length has here the angle that the joint in front had.
      const double bend_rad_m = (angle_rad[k - 1] - angle_rad[k]) / steps.chain.link_length_m();
      force_n += torque_nm(steps, setpoints, angle_rad, k) * bend_rad_m;
    }
    EXPECT_GT(force_n, ground_n) << "phase " << 0.8 * i << ": more than the friction of the ground";
  }
}

// A peg on the right flank presses to the left. Where the body points to the right of its course, left of the body is
// partly forwards.
TEST(ObstacleAided, CountsTheForwardPartOfAContactAsSupport) {
  Steps steps;
  LinkArray angle_rad{};
  angle_rad[0] = 0.6;  // the head points 0.6 rad to the left of the rest of the body
  steps.imu.orientation = {std::cos(0.15), 0.0, 0.0, std::sin(0.15)};
  steps.touch(12, 0.0, 20.0);  // from the right, on a link with the heading 0.3 - 0.6 rad
  steps.steps(angle_rad, 1);
  const double mean_rad = (0.3 - 12.0 * 0.3) / 13.0;  // which is the course
  const double forward_n = -20.0 * std::sin(-0.3 - mean_rad);
  EXPECT_GT(forward_n, 0.0);
  EXPECT_NEAR(steps.body.scratch[4], 0.02 * forward_n, 1e-9) << "after one tick of a low-pass of 1 s";
}

TEST(ObstacleAided, MirroredContactsGiveMirroredSetpoints) {
  Steps left, right;
  left.touch(0, -8.0, 6.0);
  left.touch(9, 1.0, 15.0);
  right.touch(0, -8.0, -6.0);
  right.touch(9, 1.0, -15.0);
  // The swing of the head begins with the same phase, which is its mirror image half a period later.
  right.body.wave.phase_rad = std::numbers::pi;
  for (int i = 0; i < 100; ++i) {
    const LinkArray angle_rad = wave(0.5, 0.05 * i), mirrored_rad = wave(-0.5, 0.05 * i);
    const Setpoints a = left.step(angle_rad), b = right.step(mirrored_rad);
    for (std::size_t k = 0; k < 12; ++k) {
      const std::size_t j = left.chain.joint_index(k);
      EXPECT_NEAR(a.position_rad[j], -b.position_rad[j], 1e-9) << "tick " << i << ", joint " << j;
      EXPECT_NEAR(a.torque_limit_nm[j], b.torque_limit_nm[j], 1e-9);
    }
  }
}

TEST(ObstacleAided, TheHeadTurnsAwayFromAPegThatStopsIt) {
  Steps free, stopped;
  stopped.touch(0, -8.0, 6.0);  // the peg is in front, to the right
  const double free_rad = free.steps({}, 5).position_rad[0];
  EXPECT_GT(stopped.steps({}, 5).position_rad[0], free_rad + 0.5);
  Steps beside;
  beside.touch(0, -1.0, 8.0);  // the head slides along a peg
  EXPECT_NEAR(beside.steps({}, 5).position_rad[0], free_rad, 1e-9);
}

/// The largest setpoint of the pitch joints.
double lift_rad(const Setpoints& setpoints) {
  double lift = 0.0;
  for (std::size_t j = 1; j < 23; j += 2) lift = std::max(lift, std::abs(setpoints.position_rad[j]));
  return lift;
}

TEST(ObstacleAided, MovesSidewaysAfterThreeSecondsWithoutSupport) {
  Steps alone;
  EXPECT_EQ(lift_rad(alone.steps({}, 145)), 0.0);
  EXPECT_GT(lift_rad(alone.steps({}, 60)), 0.1);
  EXPECT_LT(lift_rad(alone.steps({}, 100)), 1e-9) << "after two seconds it tries again";
  Steps supported;
  supported.touch(10, 20.0, 0.0);
  for (int i = 0; i < 400; ++i) EXPECT_EQ(lift_rad(supported.step({})), 0.0);
}

TEST(ObstacleAided, WithoutContactSensorsItNeverSearches) {
  Steps numb;
  numb.felt.module_count = 0;
  for (int i = 0; i < 400; ++i) EXPECT_EQ(lift_rad(numb.step({})), 0.0);
}

/// Servos that touch pegs: now on one flank, now on the other one, now not at all.
class PegServos : public IdealServos {
 public:
  PegServos(Wiring& wiring, const Setup& setup)
      : IdealServos(wiring, setup), contacts_(wiring.output(topics::kContactState)) {}
  void sample(const Tick& tick) override {
    IdealServos::sample(tick);
    msg::ContactState felt{};
    felt.module_count = 24;
    const std::int64_t part = tick.index / 70 % 3;
    if (part < 2) {
      felt.contact_count = 1;
      felt.contacts[0].normal = {-0.6, part == 0 ? 0.8 : -0.8, 0.0};
      felt.contacts[0].force_n = {-12.0, part == 0 ? 16.0 : -16.0, 0.0};
    }
    contacts_.write(felt);
  }

 private:
  Output<msg::ContactState> contacts_;
};

bool script(const Tick&, msg::DesiredTrajectory& desired) {
  set_motion(desired, "obstacle_aided", 1);
  desired.speed_m_s = 0.45;
  return true;
}

TEST(ObstacleAided, KeepsTheLimitsOfTheJoints) {
  LocalRun run = make_run<PegServos>(script);
  run.advance(1);
  for (int i = 0; i < 30; ++i) {
    EXPECT_LE(largest_step_rad(run, 20), 4.0 * 0.02 + 1e-12);
    const msg::JointCommand& command = *run.latest(topics::kJointCommand);
    for (int j = 0; j < 23; ++j) {
      EXPECT_LE(std::abs(command.position_rad[j]), 1.5);
      EXPECT_LE(command.torque_limit_nm[j], 6.0);
    }
  }
  EXPECT_TRUE(run.latest(topics::kMotionStatus)->accepted);
}

TEST(ObstacleAided, ContinuesIdenticallyAfterARestart) {
  LocalRun whole = make_run<PegServos>(script);
  LocalRun broken = make_run<PegServos>(script);
  whole.advance(600);
  broken.advance(231);
  broken.restart("control");
  broken.advance(200);
  broken.restart("control");
  broken.advance(169);
  EXPECT_EQ(whole.output_hashes().at("control"), broken.output_hashes().at("control"));
}

TEST(ObstacleAided, LeavesBackwardMotionAndPosturesToUndulation) {
  const MethodRegistry registry;
  const YawChain chain(load_robot(data_path("components/lib/robot/mamba.yaml")));
  msg::DesiredTrajectory desired{};
  desired.speed_m_s = -0.45;
  EXPECT_FALSE(registry.find("obstacle_aided")->accepts(desired, chain));
  desired.speed_m_s = 0.45;
  EXPECT_TRUE(registry.find("obstacle_aided")->accepts(desired, chain));
  set_u(desired);
  EXPECT_FALSE(registry.find("obstacle_aided")->accepts(desired, chain));
}

}  // namespace
}  // namespace constrictor
