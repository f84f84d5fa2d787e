#include "sim/physics/perturbation_script.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/usual_joint.hpp"

namespace constrictor {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A world with an object on a floor without friction, far from the robot: its momentum is force times time.
class PerturbationScriptTest : public ::testing::Test {
 protected:
  PerturbationScriptTest() {
    robot_.module_count = 2;
    robot_.module_length_m = 0.1;
    robot_.module_radius_m = 0.035;
    robot_.module_mass_kg = 0.3;
    robot_.joints = {testing::usual_joint()};
    robot_.friction_along = 0.05;
    robot_.friction_across = 0.5;
    robot_.torque_filter_s = 0.15;
    ScenarioObject object;
    object.mass_kg = 0.5;
    object.position_m = {3.0, 0.0};
    scenario_.objects.push_back(object);
    scenario_.friction.object_ground = 0.0;
  }
  /// [m/s] velocity of the object after a time, in ticks of 20 ms.
  double velocity_after(double seconds) {
    World world(robot_, scenario_);
    PerturbationScript script(scenario_);
    for (int tick = 0; tick < std::lround(seconds / 0.02); ++tick) {
      script.apply(world, 0.02 * tick);
      world.advance(0.02);
    }
    return world.object_velocity_m_s(0).x();
  }

  /// [m] way of the object in a time.
  Eigen::Vector2d way_after(double seconds) {
    World world(robot_, scenario_);
    PerturbationScript script(scenario_);
    for (int tick = 0; tick < std::lround(seconds / 0.02); ++tick) {
      script.apply(world, 0.02 * tick);
      world.advance(0.02);
    }
    return world.object_pose(0).translation().head<2>() - scenario_.objects[0].position_m;
  }

  RobotModel robot_;
  Scenario scenario_;
};

TEST_F(PerturbationScriptTest, ActsFromItsTimeForItsDuration) {
  scenario_.perturbations.push_back({0, 0.5, kNan, 0.4, {1.0, 0.0, 0.0}, Eigen::Vector2d(0.0, 0.0)});
  EXPECT_NEAR(velocity_after(0.5), 0.0, 1e-6);
  EXPECT_NEAR(velocity_after(0.7), 0.2 * 1.0 / 0.5, 1e-3);
  EXPECT_NEAR(velocity_after(1.5), 0.4 * 1.0 / 0.5, 1e-3);
}

TEST_F(PerturbationScriptTest, BeginsOnceTheObjectWasMoved) {
  scenario_.perturbations.push_back(
      {0, 0.1, kNan, 0.2, {1.0, 0.0, 0.0}, Eigen::Vector2d(0.0, 0.0)});  // accelerates it to 0.4 m/s
  scenario_.perturbations.push_back(
      {0, kNan, 0.3, 0.2, {1.0, 0.0, 0.0}, Eigen::Vector2d(0.0, 0.0)});  // after 0.3 m: to 0.8 m/s
  EXPECT_NEAR(velocity_after(0.7), 0.4, 1e-3);
  EXPECT_NEAR(velocity_after(1.6), 0.8, 1e-3);
}

TEST_F(PerturbationScriptTest, CarriesTheObjectAwayOnceAndItRestsThere) {
  scenario_.perturbations.push_back(
      {0, 0.2, kNan, 0.2, {1.0, 0.0, 0.0}, Eigen::Vector2d(0.0, 0.0)});  // it slides at 0.4 m/s when it is taken
  scenario_.perturbations.push_back({0, 0.5, kNan, 0.0, {0.0, 0.0, 0.0}, Eigen::Vector2d(0.3, -0.4)});
  const Eigen::Vector2d before = way_after(0.5);
  EXPECT_GT(before.x(), 0.05);
  EXPECT_NEAR(before.y(), 0.0, 1e-6);
  EXPECT_LT((way_after(0.52) - before - Eigen::Vector2d(0.3, -0.4)).norm(), 1e-3);
  EXPECT_LT((way_after(2.0) - before - Eigen::Vector2d(0.3, -0.4)).norm(), 1e-3);
}

}  // namespace
}  // namespace constrictor
