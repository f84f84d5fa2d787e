// The servo in torque mode, compared with the equations of a rotating mass, and with energy in the world.
#include <gtest/gtest.h>

#include <cmath>

#include "support/usual_joint.hpp"
#include "unit/world/servo_joint.hpp"
#include "unit/world/world_fixture.hpp"

namespace constrictor {
namespace {

JointSetpoint torque(double torque_nm, double limit_nm = 6.0) { return {0.0, 0.0, limit_nm, torque_nm, true}; }

TEST(ServoTorque, AcceleratesJointAndRotor) {
  Joint joint(testing::usual_joint(), 0.04);
  for (int i = 0; i < 10; ++i) joint.tick(torque(-0.3));
  const double time_s = 10 * kTick_s;
  EXPECT_NEAR(joint.rate_rad_s, -0.3 / 0.05 * time_s, 1e-9);
  EXPECT_NEAR(joint.angle_rad, -0.5 * 0.3 / 0.05 * time_s * (time_s + kStep_s), 1e-9);
  EXPECT_NEAR(joint.torque_nm, -0.3 * 0.04 / 0.05, 1e-9) << "the rotor takes its share of the torque";
}

TEST(ServoTorque, ALoadAndItsOppositeTorqueBalance) {
  Joint joint(testing::usual_joint(), 0.02);
  joint.load_nm = 2.5;
  for (int i = 0; i < 50; ++i) joint.tick(torque(-2.5));
  EXPECT_NEAR(joint.angle_rad, 0.0, 1e-9);
  EXPECT_NEAR(joint.torque_nm, -2.5, 1e-9);
}

TEST(ServoTorque, ExertsAtMostTheLimitOfTheCommand) {
  Joint joint(testing::usual_joint(), 0.04);
  for (int i = 0; i < 5; ++i) joint.tick(torque(5.0, 0.3));
  EXPECT_NEAR(joint.rate_rad_s, 0.3 / 0.05 * 5 * kTick_s, 1e-9);
}

TEST(ServoTorque, NeverDrivesTheJointBeyondItsMaximumSpeed) {
  for (const double rotor : {0.0, 0.001, 0.01}) {
    JointModel model = testing::usual_joint();
    model.rotor_inertia_kg_m2 = rotor;
    model.max_rad = 1e9;
    Joint joint(model, 0.05);
    double fastest = 0.0;
    for (int i = 0; i < 100; ++i) {
      joint.tick(torque(6.0));
      fastest = std::max(fastest, joint.rate_rad_s);
    }
    // Without a rotor the last step may end beyond the maximum speed, by what the torque gives in one step.
    EXPECT_LE(fastest, 4.0 + (rotor > 0.0 ? 1e-9 : 6.0 / 0.05 * kStep_s)) << "rotor inertia " << rotor;
    EXPECT_GT(fastest, 3.9) << "rotor inertia " << rotor;
  }
}

TEST(ServoTorque, TheJointComesToRestAtItsLimitAndLeavesItAgain) {
  for (const double push_nm : {0.2, 1.5, 6.0}) {
    Joint joint(testing::usual_joint(), 0.02);
    double furthest = 0.0;
    for (int i = 0; i < 150; ++i) {
      joint.tick(torque(push_nm));
      furthest = std::max(furthest, joint.angle_rad);
    }
    EXPECT_LT(furthest, 1.57 + 0.01) << push_nm;
    EXPECT_NEAR(joint.angle_rad, 1.57, 0.005) << push_nm;
    EXPECT_NEAR(joint.rate_rad_s, 0.0, 0.01) << push_nm;
    for (int i = 0; i < 20; ++i) joint.tick(torque(-0.2));
    EXPECT_LT(joint.angle_rad, 1.4) << "a torque away from the limit is obeyed";
  }
}

TEST(ServoTorque, AMotorLosesTorqueWithSpeed) {
  // (I + J) w' = T (1 - w / w0) has the solution w = w0 (1 - exp(-t T / (w0 (I + J)))).
  JointModel weak = testing::usual_joint();
  weak.max_torque_nm = 2.0;
  weak.no_load_speed_rad_s = 3.0;
  weak.max_rad = 1e9;
  Joint joint(weak, 0.19);
  for (int i = 0; i < 25; ++i) joint.tick(torque(2.0));
  const double expected = 3.0 * (1.0 - std::exp(-25 * kTick_s * 2.0 / (3.0 * 0.2)));
  EXPECT_NEAR(joint.rate_rad_s, expected, 0.02 * expected);
}

TEST(ServoTorque, TheFrictionOfTheGearIsOvercomeAndThenSubtracted) {
  JointModel rough = testing::usual_joint();
  rough.gear_friction_nm = 0.5;
  Joint stuck(rough, 0.04);
  for (int i = 0; i < 50; ++i) stuck.tick(torque(0.45));
  EXPECT_NEAR(stuck.angle_rad, 0.0, 1e-9);
  Joint pushed(rough, 0.04);
  for (int i = 0; i < 5; ++i) pushed.tick(torque(0.8));
  EXPECT_NEAR(pushed.rate_rad_s, (0.8 - 0.5) / 0.05 * 5 * kTick_s, 1e-9);
  for (int i = 0; i < 20; ++i) pushed.tick(torque(0.0));
  EXPECT_NEAR(pushed.rate_rad_s, 0.0, 1e-3) << "friction alone stops the joint, and does not turn it round";
}

TEST(ServoTorque, TheFrictionOfAGearWithoutARotorBrakesTheJoint) {
  JointModel rough = testing::usual_joint();
  rough.gear_friction_nm = 0.5;
  rough.rotor_inertia_kg_m2 = 0.0;
  Joint joint(rough, 0.04);
  joint.rate_rad_s = 2.0;
  for (int i = 0; i < 5; ++i) joint.tick(torque(0.0));
  EXPECT_NEAR(joint.rate_rad_s, 2.0 - 0.5 / 0.04 * 5 * kTick_s, 1e-6);
  for (int i = 0; i < 20; ++i) joint.tick(torque(0.0));
  EXPECT_NEAR(joint.rate_rad_s, 0.0, 1e-3);
}

TEST(ServoTorque, ASeriesSpringPassesTheTorqueOn) {
  JointModel elastic = testing::usual_joint();
  elastic.stiffness_nm_rad = 60.0;
  elastic.damping_nm_s_rad = 0.5;
  Joint joint(elastic, 0.04);
  for (int i = 0; i < 20; ++i) joint.tick(torque(0.3));
  // The spring's own swing has died away: motor and joint turn together, and the spring carries the joint's share.
  EXPECT_NEAR(joint.rate_rad_s, 0.3 / 0.05 * 20 * kTick_s, 0.02);
  EXPECT_NEAR(joint.servo.motor_angle_rad() - joint.angle_rad, 0.3 * 0.04 / 0.05 / 60.0, 1e-4);
}

TEST(ServoTorque, PositionControlBeginsWhereTheTorqueHasMovedTheJoint) {
  Joint joint(testing::usual_joint(), 0.04);
  for (int i = 0; i < 20; ++i) joint.tick(torque(0.2));
  const double begin_rad = joint.angle_rad, rate = joint.rate_rad_s;
  joint.tick({begin_rad, 0.0, 6.0});
  EXPECT_NEAR(joint.angle_rad, begin_rad, 0.5 * rate * kTick_s) << "the curve does not begin at an older setpoint";
}

TEST(ServoTorque, WorkOfTheTorqueIsTheEnergyOfTheLinks) {
  // Two equal links in the air. By symmetry each turns by p = q / 2 about its centre, which moves by d sin p across:
  // T = I p'^2 + m d^2 sin(p)^2 p'^2 + J q'^2 / 2, and the torque has done the work u q.
  RobotModel robot = chain(2, JointAxis::kYaw);
  robot.joints[0].rotor_inertia_kg_m2 = 0.002;
  robot.joints[0].max_speed_rad_s = 100.0;
  const double inertia = capsule_inertia(robot.module_mass_kg, robot.module_radius_m, robot.module_length_m);
  const double d = 0.5 * robot.module_length_m, u = 0.02;
  SolverSettings fine;
  fine.step_s = 0.0005;  // the work of a step is known only roughly, so the steps are short
  World world(robot, in_the_air(8.0), fine);
  while (world.joint_angle_rad(0) < 1.0) {
    world.set_servo(std::vector<JointSetpoint>{torque(u)});
    world.advance(kPeriod_s);
    ASSERT_LT(world.time_s(), 2.0);
    const double q = world.joint_angle_rad(0), rate = world.joint_rate_rad_s(0);
    if (q < 0.1) continue;
    const double p = 0.5 * q, p_rate = 0.5 * rate;
    const double energy_j =
        (inertia + robot.module_mass_kg * std::pow(d * std::sin(p), 2)) * p_rate * p_rate + 0.5 * 0.002 * rate * rate;
    EXPECT_NEAR(energy_j, u * q, 0.02 * u * q) << "at " << q << " rad";
  }
}

TEST(ServoTorque, TheWorldRefusesAWrongNumberOfSetpoints) {
  World world(mamba(), {});
  EXPECT_THROW(world.set_servo(std::vector<JointSetpoint>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace constrictor
