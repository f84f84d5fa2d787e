// Contacts of the world: friction, forces on objects, self-contact, walls.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "unit/world/world_fixture.hpp"

namespace constrictor {
namespace {

class Contact : public EachEngine {};
INSTANTIATE_TEST_SUITE_P(Engines, Contact, kEngines, engine_name);

using Eigen::Vector3d;

TEST_P(Contact, GroundForcesStayWithinTheAnisotropicFrictionAndReachIt) {
  World world(mamba(), {}, settings());
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
  // Modules hardly roll or pitch, so their axes are the axes of the friction. The forces of a tick are summed in frames
  // that turn during the tick: a hundredth of the friction across appears along the module.
  EXPECT_NEAR(along, world.robot().friction_along, 0.0035);
  EXPECT_NEAR(across, world.robot().friction_across, 0.03 * world.robot().friction_across);
  EXPECT_NEAR(weight, 24 * 0.3 * kG, 0.03 * 24 * 0.3 * kG);
}

TEST_P(Contact, PushesAnObjectWithTheForceThatItFeels) {
  // The head bends against an object, which slides. In steady sliding the contacts carry mu m g.
  Scenario scenario = with_object({0.085, 0.085, 0.15}, 0.4);
  scenario.objects[0].position_m = {-0.02, 0.128};
  World world(mamba(), scenario, settings());
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
  EXPECT_NEAR(force, 0.4 * 0.4 * kG, 0.03 * 0.4 * 0.4 * kG);
}

TEST_P(Contact, SelfContactIsFeltByBothModulesEqually) {
  World world(mamba(), {}, settings());
  std::vector<double> angles(23, 0.0);
  bool seen = false;
  for (int tick = 0; tick < 200;
       ++tick) {  // coils up slowly, because forces are summed in frames that turn during a tick
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
    EXPECT_LT(sum.norm(), 0.03 * largest);
  }
  EXPECT_TRUE(seen);
}

TEST_P(Contact, WallsStopTheRobot) {
  Scenario scenario;
  scenario.obstacles.push_back({BodyShape::kBox, {0.1, 4.0, 0.3}, {1.2, 0.0}, 0.0});
  World world(mamba(), scenario, settings());
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
