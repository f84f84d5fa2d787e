// The world against mechanics: laws and formulas that no solver setting changes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/world/open_loop_gait.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod_s = 0.02;
constexpr double kG = 9.81;

RobotModel mamba() { return load_robot(std::filesystem::path(ROBOT_DIR) / "mamba.yaml"); }

RobotModel chain(std::size_t modules, JointAxis axis) {
  RobotModel robot = mamba();
  robot.module_count = modules;
  robot.joints.resize(modules - 1);
  for (JointModel& joint : robot.joints) joint.axis = axis;
  return robot;
}

Scenario in_the_air(double height_m) {
  Scenario scenario;
  scenario.start_height_m = height_m;
  return scenario;
}

Scenario with_object(const Vector3d& size_m, double mass_kg) {
  Scenario scenario;
  ScenarioObject object;
  object.size_m = size_m;
  object.mass_kg = mass_kg;
  object.position_m = {2.0, 0.0};
  scenario.objects.push_back(object);
  return scenario;
}

void hold(World& world, double angle_rad, double torque_nm, double seconds) {
  const std::size_t n = world.joint_count();
  world.set_servo(std::vector<double>(n, angle_rad), std::vector<double>(n, 0.0), std::vector<double>(n, torque_nm));
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kPeriod_s)); ++i) world.advance(kPeriod_s);
}

/// Moment of inertia of a solid capsule about a transverse axis through its centre; `length` is the cylinder's.
double capsule_inertia(double mass, double radius, double length) {
  const double cylinder = std::numbers::pi * radius * radius * length;
  const double sphere = 4.0 / 3.0 * std::numbers::pi * std::pow(radius, 3);
  const double mc = mass * cylinder / (cylinder + sphere);
  const double ms = mass - mc;
  // Each half sphere's own centre lies 3/8 r beyond the cylinder's end.
  return mc * (radius * radius / 4 + length * length / 12) +
         ms * (2.0 / 5.0 * radius * radius + length * length / 4 + 3.0 / 8.0 * length * radius);
}

TEST(Mechanics, AFallingRobotFollowsTheParabola) {
  World world(mamba(), in_the_air(3.0));
  const double start = world.module_pose(5).translation().z();
  hold(world, 0.0, 6.0, 0.6);
  // The solver's steps add g t h / 2 to the fall.
  EXPECT_NEAR(start - world.module_pose(5).translation().z(), 0.5 * kG * 0.36 + 0.5 * kG * 0.6 * 0.002, 1e-6);
  EXPECT_NEAR(world.imu().proper_acceleration_m_s2.norm(), 0.0, 1e-6);  // weightless
}

TEST(Mechanics, SwingingInTheAirKeepsMomentum) {
  World world(mamba(), in_the_air(6.0));
  const double mass = world.robot().module_mass_kg;
  OpenLoopGait gait;
  const auto momenta = [&] {
    Vector3d centre = Vector3d::Zero();
    Vector3d linear = Vector3d::Zero();
    for (std::size_t i = 0; i < 24; ++i) {
      centre += world.module_pose(i).translation() / 24;
      linear += mass * world.module_velocity_m_s(i);
    }
    double angular = 0.0;  // about the vertical through the centre of mass
    const double inertia = capsule_inertia(mass, world.robot().module_radius_m, world.robot().module_length_m);
    for (std::size_t i = 0; i < 24; ++i) {
      const Vector3d r = world.module_pose(i).translation() - centre;
      angular += mass * r.cross(world.module_velocity_m_s(i)).z() + inertia * world.module_angular_velocity_rad_s(i).z();
    }
    return std::pair{linear, angular};
  };
  double largest_speed = 0.0;
  for (int tick = 0; tick < 50; ++tick) {
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    largest_speed = std::max(largest_speed, world.module_velocity_m_s(23).head<2>().norm());
  }
  const auto [linear, angular] = momenta();
  EXPECT_GT(largest_speed, 0.2);  // it does swing
  EXPECT_NEAR(linear.x(), 0.0, 1e-9);
  EXPECT_NEAR(linear.y(), 0.0, 1e-9);
  EXPECT_NEAR(linear.z(), -24 * mass * kG * 1.0, 1e-6);
  EXPECT_NEAR(angular, 0.0, 0.002);
}

TEST(Mechanics, ASlidingBlockStopsAfterItsKineticEnergyIsSpent) {
  for (const double mu : {0.2, 0.4}) {
    Scenario scenario = with_object({0.1, 0.1, 0.06}, 0.5);
    scenario.friction.object_ground = mu;
    World world(chain(2, JointAxis::kYaw), scenario);
    hold(world, 0.0, 6.0, 0.2);
    world.apply_force(0, {40.0, 0.0, 0.0});
    world.advance(kPeriod_s);
    const double speed = world.object_velocity_m_s(0).x();
    EXPECT_NEAR(speed, (40.0 / 0.5 - mu * kG) * kPeriod_s, 0.02);
    const double from = world.object_pose(0).translation().x();
    hold(world, 0.0, 6.0, 2.0);
    EXPECT_NEAR(world.object_pose(0).translation().x() - from, speed * speed / (2 * mu * kG), 0.01) << "mu " << mu;
    EXPECT_NEAR(world.object_velocity_m_s(0).norm(), 0.0, 1e-3);
  }
}

TEST(Mechanics, ABlockAtRestStaysUntilFrictionIsOvercome) {
  World world(chain(2, JointAxis::kYaw), with_object({0.1, 0.1, 0.06}, 0.5));
  const double limit = 0.4 * 0.5 * kG;
  hold(world, 0.0, 6.0, 0.2);
  for (int i = 0; i < 50; ++i) {
    world.apply_force(0, {0.9 * limit, 0.0, 0.0});
    world.advance(kPeriod_s);
  }
  EXPECT_LT(world.object_pose(0).translation().x() - 2.0, 0.005);
  for (int i = 0; i < 50; ++i) {
    world.apply_force(0, {1.3 * limit, 0.0, 0.0});
    world.advance(kPeriod_s);
  }
  EXPECT_NEAR(world.object_velocity_m_s(0).x(), 0.3 * limit / 0.5, 0.05);
}

TEST(Mechanics, ATallObjectPushedAtItsTopFallsOver) {
  // A force at the centre of a cylinder higher than wide, beyond m g r / (h / 2), with friction that holds the foot.
  Scenario scenario = with_object({0.05, 0.05, 0.3}, 0.5);
  scenario.friction.object_ground = 3.0;
  World world(chain(2, JointAxis::kYaw), scenario);
  hold(world, 0.0, 6.0, 0.2);
  const double tipping = 0.5 * kG * 0.05 / 0.15;
  for (int i = 0; i < 50; ++i) {
    world.apply_force(0, {0.7 * tipping, 0.0, 0.0});
    world.advance(kPeriod_s);
  }
  EXPECT_GT(world.object_pose(0).linear()(2, 2), 0.99);
  for (int i = 0; i < 50; ++i) {
    world.apply_force(0, {1.6 * tipping, 0.0, 0.0});
    world.advance(kPeriod_s);
  }
  hold(world, 0.0, 6.0, 1.0);
  EXPECT_LT(world.object_pose(0).linear()(2, 2), 0.3);
}

TEST(Mechanics, AnElasticJointSwingsAtItsNaturalFrequency) {
  // Two equal links with a torsion spring between them, falling freely: their centres stay on the parabola while both turn by
  // opposite angles, so w^2 = 2 k / I with I about a link's centre.
  RobotModel robot = chain(2, JointAxis::kYaw);
  const double inertia = capsule_inertia(robot.module_mass_kg, robot.module_radius_m, robot.module_length_m);
  const double w = 15.0;
  robot.joints[0].stiffness_nm_rad = w * w * inertia / 2;
  robot.joints[0].max_torque_nm = 1.0;
  World world(robot, in_the_air(8.0), [] {
    SolverSettings fine;
    fine.step_s = 0.0002;
    return fine;
  }());
  // The motor jumps to 0.2 rad; the joint follows like a pendulum let go.
  const double motor = 0.2;
  std::vector<double> crossings;
  double before = 0.0;
  world.set_servo(std::vector{motor}, std::vector{0.0}, std::vector{1.0});
  double reached = 0.0;
  for (int i = 0; i < 500; ++i) {
    world.advance(0.002);
    const double now = world.joint_angle_rad(0) - motor;
    if (i > 150 && before * now < 0.0) crossings.push_back(0.002 * (i + before / (before - now)));
    before = now;
    reached = std::max(reached, world.joint_angle_rad(0));
  }
  EXPECT_GT(reached, 0.2);
  ASSERT_GE(crossings.size(), 2U);
  const double half_period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  EXPECT_NEAR(std::numbers::pi / half_period, w, 0.03 * w);
}

/// A chain whose first joint lifts the head. Returns the torque that the joint must exert about +y (nose down) on the head.
double lifted_head_torque(const World& world) {
  const Vector3d joint = world.module_pose(0) * Vector3d(-0.5 * world.robot().module_length_m, 0, 0);
  const double lever = world.module_pose(0).translation().x() - joint.x();
  return -world.robot().module_mass_kg * kG * lever;  // holds up what gravity turns nose down
}

TEST(Mechanics, AStiffJointMeasuresTheWeightItLifts) {
  RobotModel robot = chain(8, JointAxis::kPitch);
  World world(robot, {});
  std::vector<double> angles(7, 0.0);
  angles[0] = -0.6;
  world.set_servo(angles, std::vector<double>(7, 0.0), std::vector<double>(7, 6.0));
  for (int i = 0; i < 150; ++i) world.advance(kPeriod_s);
  EXPECT_NEAR(world.joint_angle_rad(0), -0.6, 0.02);
  EXPECT_NEAR(world.joint_torque_nm(0), lifted_head_torque(world), 0.02);
}

TEST(Mechanics, AnElasticJointSagsByTorqueOverStiffness) {
  RobotModel robot = chain(8, JointAxis::kPitch);
  for (JointModel& joint : robot.joints) joint.stiffness_nm_rad = 3.0;
  for (JointModel& joint : robot.joints) joint.damping_nm_s_rad = 0.05;
  World world(robot, {});
  std::vector<double> angles(7, 0.0);
  angles[0] = -0.6;
  world.set_servo(angles, std::vector<double>(7, 0.0), std::vector<double>(7, 6.0));
  for (int i = 0; i < 200; ++i) world.advance(kPeriod_s);
  const double torque = lifted_head_torque(world);
  EXPECT_LT(torque, -0.05);
  EXPECT_NEAR(world.joint(0).motor_angle_rad() - world.joint_angle_rad(0), torque / 3.0, 0.003);
  EXPECT_NEAR(world.joint(0).motor_angle_rad(), -0.6, 1e-3);
}

TEST(Mechanics, AJointNeverExceedsItsTorqueLimit) {
  // Limit below what the lifted head needs: it stays down.
  RobotModel robot = chain(8, JointAxis::kPitch);
  World world(robot, {});
  std::vector<double> angles(7, 0.0);
  angles[0] = -0.6;
  world.set_servo(angles, std::vector<double>(7, 0.0), std::vector<double>(7, 0.05));
  for (int i = 0; i < 100; ++i) world.advance(kPeriod_s);
  EXPECT_GT(world.joint_angle_rad(0), -0.1);
  EXPECT_LE(std::abs(world.joint_torque_nm(0)), 0.0501);
}

TEST(Mechanics, ARelaxedJointExertsNoTorque) {
  World world(mamba(), {});
  hold(world, 0.0, 0.0, 1.0);
  for (std::size_t i = 0; i < 23; ++i) EXPECT_NEAR(world.joint_torque_nm(i), 0.0, 1e-6);
}

TEST(Mechanics, GroundForcesStayWithinTheAnisotropicFrictionAndReachIt) {
  World world(mamba(), {});
  OpenLoopGait gait;
  double along = 0.0;
  double across = 0.0;
  double weight = 0.0;
  for (int tick = 0; tick < 250; ++tick) {
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    if (tick < 150) continue;
    for (const ModuleContact& contact : world.contacts()) {
      ASSERT_EQ(contact.touched, Touched::kGround);
      weight += contact.force_n.z() / 100;
      if (contact.force_n.z() < 0.3) continue;
      along = std::max(along, std::abs(contact.force_n.x()) / contact.force_n.z());
      across = std::max(across, std::abs(contact.force_n.y()) / contact.force_n.z());
    }
  }
  // Modules hardly roll or pitch, so their axes are the friction's.
  EXPECT_NEAR(along, world.robot().friction_along, 0.02);
  EXPECT_NEAR(across, world.robot().friction_across, 0.05);
  EXPECT_NEAR(weight, 24 * 0.3 * kG, 0.03 * 24 * 0.3 * kG);
}

TEST(Mechanics, PushesAnObjectWithTheForceThatItFeels) {
  // The head bends into an object that slides: in steady sliding the contacts carry mu m g, up to sqrt 2 more because ODE bounds
  // friction by a pyramid.
  Scenario scenario = with_object({0.085, 0.085, 0.15}, 0.4);
  scenario.objects[0].position_m = {-0.02, 0.128};
  World world(mamba(), scenario);
  std::vector<double> angles(23, 0.0);
  double force = 0.0;
  for (int tick = 0; tick < 141; ++tick) {
    for (const std::size_t joint : {0, 2, 4}) angles[joint] = std::min(0.35, 0.12 * tick * kPeriod_s);
    world.set_servo(angles, std::vector<double>(23, 0.0), std::vector<double>(23, 6.0));
    world.advance(kPeriod_s);
    Vector3d total = Vector3d::Zero();
    for (const ModuleContact& contact : world.contacts()) {
      if (contact.touched != Touched::kObject) continue;
      total += world.module_pose(contact.module_index).linear() * contact.force_n;
      EXPECT_LT(contact.normal.y(), 0.0);  // the object is on the left: the normal points right, into the module
    }
    if (tick > 100) force += total.head<2>().norm() / 40;
  }
  EXPECT_GT(world.object_velocity_m_s(0).norm(), 0.01);
  EXPECT_GT(force, 0.85 * 0.4 * 0.4 * kG);
  EXPECT_LT(force, 1.5 * 0.4 * 0.4 * kG);
}

TEST(Mechanics, SelfContactIsFeltByBothModulesEqually) {
  World world(mamba(), {});
  std::vector<double> angles(23, 0.0);
  bool seen = false;
  for (int tick = 0; tick < 200; ++tick) {  // coils up slowly: forces are summed in frames that turn within the tick
    for (std::size_t i = 0; i < 23; i += 2) angles[i] = std::min(0.9, 0.005 * tick);
    world.set_servo(angles, std::vector<double>(23, 0.0), std::vector<double>(23, 6.0));
    world.advance(kPeriod_s);
    Vector3d sum = Vector3d::Zero();
    double largest = 0.0;
    for (const ModuleContact& contact : world.contacts()) {
      if (contact.touched != Touched::kSelf) continue;
      EXPECT_GE(std::abs(int{contact.module_index} - int{contact.touched_index}), 3);
      sum += world.module_pose(contact.module_index).linear() * contact.force_n;
      largest = std::max(largest, contact.force_n.norm());
    }
    if (largest < 0.5) continue;
    seen = true;
    EXPECT_LT(sum.norm(), 0.1 * largest);
  }
  EXPECT_TRUE(seen);
}

TEST(Mechanics, WallsStopTheRobot) {
  Scenario scenario;
  scenario.obstacles.push_back({BodyShape::kBox, {0.1, 4.0, 0.3}, {1.2, 0.0}, 0.0});
  World world(mamba(), scenario);
  OpenLoopGait gait;
  bool felt = false;
  for (int tick = 0; tick < 300; ++tick) {
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    for (const ModuleContact& contact : world.contacts()) felt = felt || contact.touched == Touched::kObstacle;
    for (std::size_t i = 0; i < 24; ++i) {
      EXPECT_LT((world.module_pose(i) * Vector3d(0.0445, 0, 0)).x(), 1.15 - 0.035 + 0.01);
    }
  }
  EXPECT_TRUE(felt);
}

}  // namespace
}  // namespace constrictor
