// Joints of the world compared with formulas: elastic and stiff joints, torque limits.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "unit/world/world_fixture.hpp"

namespace constrictor {
namespace {

class JointDrive : public EachEngine {};
INSTANTIATE_TEST_SUITE_P(Engines, JointDrive, kEngines, engine_name);

using Eigen::Vector3d;

TEST_P(JointDrive, AnElasticJointSwingsAtItsNaturalFrequency) {
  // Two equal links with a torsion spring between them fall freely. Both turn by opposite angles, so w^2 = 2 k / I with
  // I about the centre of a link.
  RobotModel robot = chain(2, JointAxis::kYaw);
  const double inertia = capsule_inertia(robot.module_mass_kg, robot.module_radius_m, robot.module_length_m);
  const double w = 15.0;
  robot.joints[0].stiffness_nm_rad = w * w * inertia / 2;
  robot.joints[0].max_torque_nm = 1.0;
  World world(robot, in_the_air(8.0), settings());
  // The motor jumps to 0.2 rad; the joint then swings about that angle.
  const double motor = 0.2;
  std::vector<double> crossings;
  double before = 0.0;
  world.set_servo(std::vector{motor}, std::vector{0.0}, std::vector{1.0});
  double reached = 0.0;
  const double step_s = settings().step_s;
  for (int i = 0; i < std::lround(1.0 / step_s); ++i) {
    world.advance(step_s);
    const double now = world.joint_angle_rad(0) - motor;
    if (i * step_s > 0.3 && before * now < 0.0) crossings.push_back(step_s * (i + before / (before - now)));
    before = now;
    reached = std::max(reached, world.joint_angle_rad(0));
  }
  EXPECT_GT(reached, 0.2);
  ASSERT_GE(crossings.size(), 2U);
  const double half_period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  EXPECT_NEAR(std::numbers::pi / half_period, w, 0.03 * w);
}

/// Commands the first pitch joint to -0.6 rad, which lifts the head, and the other joints to 0, for some ticks.
void lift_head(World& world, double torque_limit_nm, int ticks) {
  const std::size_t n = world.joint_count();
  std::vector<double> angles(n, 0.0);
  angles[0] = -0.6;
  world.set_servo(angles, std::vector<double>(n, 0.0), std::vector<double>(n, torque_limit_nm));
  for (int i = 0; i < ticks; ++i) world.advance(kPeriod_s);
}

/// [Nm] the torque about +y (nose down) that the first joint must exert on a lifted head.
double lifted_head_torque(const World& world) {
  const Vector3d joint = world.module_pose(0) * Vector3d(-0.5 * world.robot().module_length_m, 0, 0);
  const double lever = world.module_pose(0).translation().x() - joint.x();
  return -world.robot().module_mass_kg * kG * lever;  // gravity turns the nose down, the joint holds it up
}

TEST_P(JointDrive, AStiffJointMeasuresTheWeightItLifts) {
  RobotModel robot = chain(8, JointAxis::kPitch);
  World world(robot, {}, settings());
  lift_head(world, 6.0, 150);
  EXPECT_NEAR(world.joint_angle_rad(0), -0.6, 0.02);
  EXPECT_NEAR(world.joint_torque_nm(0), lifted_head_torque(world), 0.03 * std::abs(lifted_head_torque(world)));
}

TEST_P(JointDrive, AnElasticJointSagsByTorqueOverStiffness) {
  RobotModel robot = chain(8, JointAxis::kPitch);
  for (JointModel& joint : robot.joints) joint.stiffness_nm_rad = 3.0;
  for (JointModel& joint : robot.joints) joint.damping_nm_s_rad = 0.05;
  World world(robot, {}, settings());
  lift_head(world, 6.0, 200);
  const double torque = lifted_head_torque(world);
  EXPECT_LT(torque, -0.05);
  EXPECT_NEAR(world.joint(0).motor_angle_rad() - world.joint_angle_rad(0), torque / 3.0, 0.03 * std::abs(torque) / 3.0);
  EXPECT_NEAR(world.joint(0).motor_angle_rad(), -0.6, 1e-3);
}

TEST_P(JointDrive, AJointNeverExceedsItsTorqueLimit) {
  // The limit is below the torque that lifts the head, so the head stays down.
  RobotModel robot = chain(8, JointAxis::kPitch);
  World world(robot, {}, settings());
  lift_head(world, 0.05, 100);
  EXPECT_GT(world.joint_angle_rad(0), -0.1);
  EXPECT_LE(std::abs(world.joint_torque_nm(0)), 0.0501);
}

/// Two equal links that fall freely, with a joint between them whose rotor has the inertia that the joint feels of the
/// links: both turn by opposite angles about their centres, so that it feels half the inertia of a link.
RobotModel free_links() {
  RobotModel robot = chain(2, JointAxis::kYaw);
  robot.joints[0].rotor_inertia_kg_m2 =
      0.5 * capsule_inertia(robot.module_mass_kg, robot.module_radius_m, robot.module_length_m);
  robot.joints[0].gear_friction_nm = 0.0;
  robot.torque_filter_s = 0.0;
  return robot;
}

TEST_P(JointDrive, ATorqueAcceleratesLinksAndRotor) {
  const RobotModel robot = free_links();
  World world(robot, in_the_air(8.0), settings());
  const double torque_nm = -0.002;
  world.set_servo(std::vector{JointSetpoint{0.0, 0.0, 6.0, torque_nm, true}});
  const double time_s = 0.2;
  for (int i = 0; i < std::lround(time_s / kPeriod_s); ++i) world.advance(kPeriod_s);
  const double rate_rad_s = torque_nm / (2.0 * robot.joints[0].rotor_inertia_kg_m2) * time_s;
  ASSERT_LT(std::abs(rate_rad_s), 2.0) << "the angles must stay small";
  ASSERT_GT(std::abs(rate_rad_s), 0.1);
  EXPECT_NEAR(world.joint_rate_rad_s(0), rate_rad_s, 0.03 * std::abs(rate_rad_s));
  EXPECT_NEAR(world.joint_torque_nm(0), 0.5 * torque_nm, 0.015 * std::abs(torque_nm)) << "the rotor takes the rest";
}

TEST_P(JointDrive, ARelaxedJointGoesOnTurningWithItsRotor) {
  World world(free_links(), in_the_air(8.0), settings());
  world.set_servo(std::vector{JointSetpoint{0.0, 0.0, 6.0, 0.004, true}});
  for (int i = 0; i < 5; ++i) world.advance(kPeriod_s);
  const double rate_rad_s = world.joint_rate_rad_s(0);
  ASSERT_GT(rate_rad_s, 0.1);
  world.set_servo(std::vector{JointSetpoint{}});
  for (int i = 0; i < 5; ++i) world.advance(kPeriod_s);
  EXPECT_NEAR(world.joint_rate_rad_s(0), rate_rad_s, 0.02 * rate_rad_s);
  EXPECT_NEAR(world.joint_torque_nm(0), 0.0, 1e-4);
}

TEST_P(JointDrive, ARelaxedJointExertsNoTorque) {
  RobotModel robot = mamba();
  for (JointModel& joint : robot.joints) joint.rotor_inertia_kg_m2 = 0.0;  // a rotor resists acceleration
  World world(robot, {}, settings());
  hold(world, 0.0, 0.0, 1.0);
  for (std::size_t i = 0; i < 23; ++i) EXPECT_NEAR(world.joint_torque_nm(i), 0.0, 1e-6);
}

}  // namespace
}  // namespace constrictor
