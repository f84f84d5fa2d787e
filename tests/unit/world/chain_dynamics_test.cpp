// The chain in generalised coordinates: what its coordinates promise, its checkpoints, and its agreement with ODE where
// ODE has converged.
#include "sim/world/chain_dynamics.hpp"

#include <gtest/gtest.h>

#include "unit/world/world_fixture.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

SolverSettings solver(const std::string& engine, double step_s, int iterations = 50) {
  SolverSettings settings;
  settings.engine = engine;
  settings.step_s = step_s;
  settings.iterations = iterations;
  return settings;
}

/// A cylinder and a box that the robot pushes ahead of itself, and a peg beside it.
Scenario crowded() {
  Scenario scenario = with_object({0.06, 0.06, 0.15}, 0.3);
  scenario.objects[0].position_m = {0.3, 0.05};
  scenario.objects.push_back(scenario.objects[0]);
  scenario.objects[1].shape = BodyShape::kBox;
  scenario.objects[1].size_m = {0.1, 0.2, 0.1};
  scenario.objects[1].position_m = {0.5, 0.1};
  scenario.obstacles.push_back({BodyShape::kCylinder, {0.05, 0.05, 0.2}, {0.15, -0.2}, 0.0});
  return scenario;
}

TEST(ChainDynamics, HingesHoldExactly) {
  World world(mamba(), crowded(), solver(kEngineChain, 0.004));
  OpenLoopGait gait;
  gait.curvature_1_m = 0.6;
  const Vector3d half(0.5 * world.robot().module_length_m, 0.0, 0.0);
  for (int tick = 0; tick < 200; ++tick) {
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    for (std::size_t i = 0; i + 1 < world.module_count(); ++i) {
      const Eigen::Isometry3d ahead = world.module_pose(i);
      const Eigen::Isometry3d behind = world.module_pose(i + 1);
      ASSERT_LT((ahead * Vector3d(-half) - behind * half).norm(), 1e-12);
      const int axis = world.robot().joints[i].axis == JointAxis::kYaw ? 2 : 1;
      ASSERT_LT((ahead.linear().col(axis) - behind.linear().col(axis)).norm(), 1e-12);
    }
  }
}

TEST(ChainDynamics, AnglesAndRatesMeanTheSameAsWithOde) {
  // Slow motions in the air: the dynamics hardly matters, so both engines show the commanded posture.
  World chain_world(mamba(), in_the_air(3.0), solver(kEngineChain, 0.002));
  World ode_world(mamba(), in_the_air(3.0), solver(kEngineOde, 0.002, 200));
  std::vector<double> angles(23, 0.0);
  for (int tick = 1; tick <= 30; ++tick) {
    for (std::size_t i = 0; i < 23; ++i) angles[i] = 0.01 * tick * (i % 3 == 0 ? 1.0 : -0.5);
    for (World* world : {&chain_world, &ode_world}) {
      world->set_servo(angles, std::vector<double>(23, 0.0), std::vector<double>(23, 6.0));
      world->advance(kPeriod_s);
    }
  }
  for (std::size_t i = 0; i < 24; ++i) {
    const Eigen::Isometry3d relative = chain_world.module_pose(0).inverse() * chain_world.module_pose(i);
    const Eigen::Isometry3d expected = ode_world.module_pose(0).inverse() * ode_world.module_pose(i);
    EXPECT_LT((relative.matrix() - expected.matrix()).norm(), 0.01) << "module " << i;
  }
}

/// [m/s] speed of the gait, and the root of the mean square of all joint torques [Nm].
std::pair<double, double> gait_of(const SolverSettings& settings) {
  World world(mamba(), {}, settings);
  OpenLoopGait gait;
  double squares = 0.0;
  int count = 0;
  double from_m = 0.0;
  const int first = 100, last = first + 214;  // three cycles
  for (int tick = 0; tick < last; ++tick) {
    if (tick == first) from_m = world.module_pose(12).translation().x();
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    for (std::size_t j = 0; tick >= first && j < world.joint_count(); ++j, ++count)
      squares += std::pow(world.joint(j).step_torque_nm(), 2);
  }
  return {(world.module_pose(12).translation().x() - from_m) / ((last - first) * kPeriod_s),
          std::sqrt(squares / count)};
}

TEST(ChainDynamics, TheGaitEqualsThatOfOdeWithShortStepsAndManyIterations) {
  const auto [speed, torque] = gait_of(solver(kEngineChain, SolverSettings{}.step_s));
  const auto [fine_speed, fine_torque] = gait_of(solver(kEngineOde, 0.001, 200));
  EXPECT_NEAR(speed, fine_speed, 0.02 * fine_speed);
  EXPECT_NEAR(torque, fine_torque, 0.03 * fine_torque);
}

TEST(ChainDynamics, AShorterStepHardlyChangesTheGait) {
  const auto [speed, torque] = gait_of(solver(kEngineChain, SolverSettings{}.step_s));
  const auto [fine_speed, fine_torque] = gait_of(solver(kEngineChain, 0.0005));
  EXPECT_NEAR(speed, fine_speed, 0.02 * fine_speed);
  EXPECT_NEAR(torque, fine_torque, 0.02 * fine_torque);
}

TEST(ChainDynamics, EachCheckpointContinuesBitForBit) {
  for (const char* engine : {kEngineOde, kEngineChain}) {
    World world(mamba(), crowded(), solver(engine, 0.004));
    OpenLoopGait gait;
    int tick = 0;
    for (; tick < 90; ++tick) gait.drive(world, tick * kPeriod_s, kPeriod_s);
    World successor(mamba(), crowded(), solver(engine, 0.004));
    successor.load(world.save());
    for (; tick < 150; ++tick) {
      gait.drive(world, tick * kPeriod_s, kPeriod_s);
      gait.drive(successor, tick * kPeriod_s, kPeriod_s);
      ASSERT_EQ(world.state_hash(), successor.state_hash()) << engine << ", tick " << tick;
    }
    EXPECT_GT((world.object_pose(0).translation() - Vector3d(0.3, 0.05, 0.075)).norm(), 0.05) << "nothing was touched";
  }
}

TEST(ChainDynamics, CheckpointsOfAnotherEngineAreRefused) {
  const World ode(mamba(), crowded(), solver(kEngineOde, 0.004));
  World chain_world(mamba(), crowded(), solver(kEngineChain, 0.004));
  EXPECT_THROW(chain_world.load(ode.save()), std::runtime_error);
  EXPECT_THROW(World(mamba(), {}, solver("bullet", 0.004)), std::invalid_argument);
}

TEST(ChainDynamics, AJointThatIsPushedBeyondItsLimitStops) {
  // A weak servo cannot hold the joint against a load; the stop does.
  RobotModel robot = chain(8, JointAxis::kPitch);
  for (JointModel& joint : robot.joints) joint.max_rad = 0.2;
  robot.joints[3].min_rad = -0.1;
  World world(robot, in_the_air(2.0), solver(kEngineChain, 0.004));
  std::vector<double> angles(7, 0.0);
  std::vector<double> limits(7, 6.0);
  limits[3] = 0.0;
  for (int tick = 0; tick < 25; ++tick) {
    for (const std::size_t joint : {2, 4}) angles[joint] = -0.03 * tick;
    world.set_servo(angles, std::vector<double>(7, 0.0), limits);
    world.advance(kPeriod_s);
    EXPECT_LT(world.joint_angle_rad(3), 0.21);
    EXPECT_GT(world.joint_angle_rad(3), -0.11);
  }
}

}  // namespace
}  // namespace constrictor
