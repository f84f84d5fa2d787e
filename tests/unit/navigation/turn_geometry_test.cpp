// The geometry of turns, compared with a drive in small steps along the circle and along the tangent.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "navigation/turn_geometry.hpp"

namespace constrictor {
namespace {

TEST(TurnTowards, LeadsToTheTargetWhenItIsDriven) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> metres(-3.0, 3.0);
  std::uniform_real_distribution<double> radii(0.1, 1.0);
  int reached = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector2d target(metres(random), metres(random));
    const double radius_m = radii(random);
    const TurnTowards turn = turn_towards(target, radius_m);
    const double side = target.y() < 0.0 ? -1.0 : 1.0;
    if (turn.straight_m < 0.0) {
      EXPECT_LT((target - Eigen::Vector2d(0.0, side * radius_m)).norm(), radius_m);
      continue;
    }
    EXPECT_GE(turn.turn_rad, 0.0);
    EXPECT_LT(turn.turn_rad, 2.0 * std::numbers::pi);
    Eigen::Vector2d p(0.0, 0.0);
    double yaw_rad = 0.0;
    constexpr int kSteps = 20000;
    for (int k = 0; k < kSteps; ++k) {
      const double middle_rad = yaw_rad + side * 0.5 * turn.turn_rad / kSteps;
      p += radius_m * turn.turn_rad / kSteps * Eigen::Vector2d(std::cos(middle_rad), std::sin(middle_rad));
      yaw_rad += side * turn.turn_rad / kSteps;
    }
    p += turn.straight_m * Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad));
    EXPECT_LT((p - target).norm(), 1e-4) << target.transpose() << " radius " << radius_m;
    ++reached;
  }
  EXPECT_GT(reached, 400);
}

}  // namespace
}  // namespace constrictor
