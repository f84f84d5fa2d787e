// Free bodies and objects compared with laws of mechanics that no setting of the solver changes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "sim/world/ground_torques.hpp"
#include "unit/world/world_fixture.hpp"

namespace constrictor {
namespace {

class Mechanics : public EachEngine {};
INSTANTIATE_TEST_SUITE_P(Engines, Mechanics, kEngines, engine_name);

using Eigen::Vector3d;

TEST_P(Mechanics, AFallingRobotFollowsTheParabola) {
  World world(mamba(), in_the_air(3.0), settings());
  const double start = world.module_pose(5).translation().z();
  hold(world, 0.0, 6.0, 0.6);
  // The integration in steps of h adds g t h / 2 to the fall.
  const double h = settings().step_s;
  EXPECT_NEAR(start - world.module_pose(5).translation().z(), 0.5 * kG * 0.36 + 0.5 * kG * 0.6 * h, 1e-6);
  EXPECT_NEAR(world.imu().proper_acceleration_m_s2.norm(), 0.0, 1e-6);  // weightless
}

/// What a robot gets by swinging for one second.
struct Swung {
  Vector3d linear_ns{0.0, 0.0, 0.0};
  double angular_nms = 0.0;        ///< about the vertical through the centre of mass
  double largest_speed_m_s = 0.0;  ///< of the tail
};

Swung swing(const Scenario& scenario, const SolverSettings& settings) {
  World world(mamba(), scenario, settings);
  const double mass = world.robot().module_mass_kg;
  OpenLoopGait gait;
  Swung swung;
  for (int tick = 0; tick < 50; ++tick) {
    gait.drive(world, tick * kPeriod_s, kPeriod_s);
    swung.largest_speed_m_s = std::max(swung.largest_speed_m_s, world.module_velocity_m_s(23).head<2>().norm());
  }
  Vector3d centre = Vector3d::Zero();
  for (std::size_t i = 0; i < 24; ++i) {
    centre += world.module_pose(i).translation() / 24;
    swung.linear_ns += mass * world.module_velocity_m_s(i);
  }
  const double inertia = capsule_inertia(mass, world.robot().module_radius_m, world.robot().module_length_m);
  for (std::size_t i = 0; i < 24; ++i) {
    const Vector3d r = world.module_pose(i).translation() - centre;
    swung.angular_nms +=
        mass * r.cross(world.module_velocity_m_s(i)).z() + inertia * world.module_angular_velocity_rad_s(i).z();
  }
  return swung;
}

TEST_P(Mechanics, SwingingInTheAirKeepsMomentum) {
  const Swung swung = swing(in_the_air(6.0), settings());
  EXPECT_GT(swung.largest_speed_m_s, 0.2);  // the robot swings indeed
  EXPECT_NEAR(swung.linear_ns.x(), 0.0, 1e-9);
  EXPECT_NEAR(swung.linear_ns.y(), 0.0, 1e-9);
  EXPECT_NEAR(swung.linear_ns.z(), -24 * mamba().module_mass_kg * kG * 1.0, 1e-6);
  EXPECT_NEAR(swung.angular_nms, 0.0, 0.002);
}

TEST_P(Mechanics, SwingingOnGroundWithoutFrictionKeepsMomentum) {
  Scenario ice;
  ice.friction.ground_scale = 0.0;
  const Swung swung = swing(ice, settings());
  EXPECT_GT(swung.largest_speed_m_s, 0.2);
  EXPECT_NEAR(swung.linear_ns.x(), 0.0, 1e-9);
  EXPECT_NEAR(swung.linear_ns.y(), 0.0, 1e-9);
  EXPECT_NEAR(swung.angular_nms, 0.0, 0.002);
}

TEST_P(Mechanics, ASlidingBlockStopsAfterItsKineticEnergyIsSpent) {
  for (const double mu : {0.2, 0.4}) {
    Scenario scenario = with_object({0.1, 0.1, 0.06}, 0.5);
    scenario.friction.object_ground = mu;
    World world(chain(2, JointAxis::kYaw), scenario, settings());
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

/// [m] how far a block slides that a force has pushed for one tick in this direction, seen from above.
Eigen::Vector2d slide(const SolverSettings& settings, double direction_rad, BodyShape shape) {
  Scenario scenario = with_object({0.1, 0.1, 0.06}, 0.5);
  scenario.objects[0].shape = shape;
  scenario.objects[0].yaw_rad = direction_rad;  // the block turns with the push: only the world's axes differ
  World world(chain(2, JointAxis::kYaw), scenario, settings);
  hold(world, 0.0, 6.0, 0.2);
  const Vector3d from = world.object_pose(0).translation();
  world.apply_force(0, 40.0 * Vector3d(std::cos(direction_rad), std::sin(direction_rad), 0.0));
  world.advance(kPeriod_s);
  hold(world, 0.0, 6.0, 1.5);
  return (world.object_pose(0).translation() - from).head<2>();
}

TEST_P(Mechanics, FrictionIsTheSameInEachDirectionOfTheWorld) {
  const double mu = Scenario{}.friction.object_ground;
  const double speed = (40.0 / 0.5 - mu * kG) * kPeriod_s;
  const double coasted_m = speed * speed / (2 * mu * kG) + 0.5 * speed * kPeriod_s;
  for (const BodyShape shape : {BodyShape::kCylinder, BodyShape::kBox}) {
    for (const double degrees : {0.0, 17.0, 30.0, 45.0, 72.0, 90.0, 135.0, -45.0, 180.0}) {
      const double direction = degrees * std::numbers::pi / 180.0;
      const Eigen::Vector2d moved = slide(settings(), direction, shape);
      EXPECT_NEAR(moved.norm(), coasted_m, 0.02 * coasted_m) << degrees;
      EXPECT_NEAR(std::remainder(std::atan2(moved.y(), moved.x()) - direction, 2.0 * std::numbers::pi), 0.0, 0.02)
          << degrees;
    }
  }
}

TEST_P(Mechanics, ABlockAtRestStaysUntilFrictionIsOvercome) {
  World world(chain(2, JointAxis::kYaw), with_object({0.1, 0.1, 0.06}, 0.5), settings());
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
  EXPECT_NEAR(world.object_velocity_m_s(0).x(), 0.3 * limit / 0.5, 0.03 * 0.3 * limit / 0.5);
}

TEST_P(Mechanics, ATallObjectPushedAtItsTopFallsOver) {
  // A force at the centre of a cylinder overturns it beyond m g r / (h / 2) if friction holds its foot.
  Scenario scenario = with_object({0.05, 0.05, 0.3}, 0.5);
  scenario.friction.object_ground = 3.0;
  World world(chain(2, JointAxis::kYaw), scenario, settings());
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

/// [m/s²] acceleration of a straight robot along x or y on a slope that falls in this direction.
double slide_robot(const SolverSettings& settings, double slope_rad, const Vector3d& downhill) {
  Scenario scenario;
  scenario.gravity_m_s2 = kG * (std::sin(slope_rad) * downhill - std::cos(slope_rad) * Vector3d::UnitZ());
  World world(chain(4, JointAxis::kYaw), scenario, settings);
  hold(world, 0.0, 6.0, 0.4);
  const double before = world.module_velocity_m_s(1).dot(downhill);
  hold(world, 0.0, 6.0, 0.4);
  // The inertial unit feels what the ground does: gravity is what it does not feel.
  const double acceleration = (world.module_velocity_m_s(1).dot(downhill) - before) / 0.4;
  const Vector3d felt = world.module_pose(0).linear() * world.imu().proper_acceleration_m_s2;
  EXPECT_NEAR((felt - acceleration * downhill + scenario.gravity_m_s2).norm(), 0.0, 0.05);
  return acceleration;
}

// A solid cylinder that rolls without slipping: m a = F - c m g and m r² a / 2 = F r give a = -2/3 c g.
TEST_P(Mechanics, ARollingCylinderIsSlowedDownByItsRollingResistance) {
  const double radius = 0.05, mass = 0.4;
  World world(mamba(), with_object({radius, radius, 0.4}, mass), settings());
  const auto push = [&](const Vector3d& force, double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kPeriod_s)); ++i) {
      world.apply_force(0, force);
      world.advance(kPeriod_s);
    }
  };
  push(0.35 * mass * kG * Vector3d::UnitX(), 1.0);
  push(Vector3d::Zero(), 2.0);
  ASSERT_NEAR(world.object_pose(0).translation().z(), radius, 0.005);  // it lies, its axis along x
  push(0.2 * mass * kG * Vector3d::UnitY(), 0.6);
  push(Vector3d::Zero(), 0.2);
  const double before = world.object_velocity_m_s(0).y();
  ASSERT_GT(before, 0.4);
  push(Vector3d::Zero(), 1.0);
  const double slowed_m_s = 2.0 / 3.0 * kRollingResistance * kG;
  EXPECT_NEAR(before - world.object_velocity_m_s(0).y(), slowed_m_s, 0.03 * slowed_m_s);
  push(Vector3d::Zero(), 6.0);
  EXPECT_LT(world.object_velocity_m_s(0).norm(), 0.01);
}

TEST_P(Mechanics, ARobotOnASlopeHoldsUpToItsFrictionAngleAndThenAccelerates) {
  const RobotModel robot = mamba();
  for (const auto& [downhill, mu] : {std::pair<Vector3d, double>(Vector3d::UnitX(), robot.friction_along),
                                     std::pair<Vector3d, double>(-Vector3d::UnitX(), robot.friction_along),
                                     std::pair<Vector3d, double>(Vector3d::UnitY(), robot.friction_across),
                                     std::pair<Vector3d, double>(-Vector3d::UnitY(), robot.friction_across)}) {
    const double angle = std::atan(mu);
    EXPECT_NEAR(slide_robot(settings(), 0.95 * angle, downhill), 0.0, 0.002);
    const double beyond = 1.2 * angle;
    const double expected = kG * (std::sin(beyond) - mu * std::cos(beyond));
    EXPECT_NEAR(slide_robot(settings(), beyond, downhill), expected, 0.01 * expected);
  }
}

TEST_P(Mechanics, AScenarioMakesTheBodyHeavierThanItsRobotFileSays) {
  Scenario heavy;
  heavy.body.mass_scale = 1.3;
  World world(mamba(), heavy, settings());
  hold(world, 0.0, 6.0, 1.0);
  double weight_n = 0.0;
  for (const ModuleContact& contact : world.contacts()) weight_n += contact.force_n.z();
  EXPECT_NEAR(weight_n, 1.3 * 24 * 0.3 * kG, 0.01 * 24 * 0.3 * kG);
}

}  // namespace
}  // namespace constrictor
