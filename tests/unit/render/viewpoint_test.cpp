// Viewpoints contain all given points, as large as possible.
#include "sim/render/viewpoint.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace constrictor {
namespace {

TEST(Viewpoint, ContainsAllPointsAndTouchesTheMargin) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 20; ++i) points.emplace_back(0.4 * i, (i * 7 % 5) * 0.3, 0.0);
  for (const double heading : {0.0, 0.9, 2.0, -2.5}) {
    for (const double elevation : {0.3, 0.8, 1.4}) {
      const PinholeCamera camera = fit_view(points, heading, elevation, 0.7, 640, 360, 0.05);
      double u_min = 1e9, u_max = -1e9, v_min = 1e9, v_max = -1e9;
      for (const Eigen::Vector3d& p : points) {
        const Eigen::Vector3d c = camera.X_WC.inverse() * p;
        ASSERT_GT(c.z(), 0.0);
        const double u = camera.fx * c.x() / c.z() + camera.cx;
        const double v = camera.fy * c.y() / c.z() + camera.cy;
        u_min = std::min(u_min, u);
        u_max = std::max(u_max, u);
        v_min = std::min(v_min, v);
        v_max = std::max(v_max, v);
      }
      EXPECT_GE(u_min, 0.05 * 640 - 1e-6);
      EXPECT_LE(u_max, 0.95 * 640 + 1e-6);
      EXPECT_GE(v_min, 0.05 * 360 - 1e-6);
      EXPECT_LE(v_max, 0.95 * 360 + 1e-6);
      EXPECT_TRUE(u_max - u_min > 0.9 * 640 - 1e-3 || v_max - v_min > 0.9 * 360 - 1e-3);
      EXPECT_NEAR(u_min + u_max, 640, 1e-3);  // the left and the right margin are equal
      EXPECT_NEAR(v_min + v_max, 360, 1e-3);
    }
  }
}

TEST(Viewpoint, TheExtentOfBodiesContainsThemAndStandsStillWhileTheyMoveALittle) {
  ScenePoses poses;
  EXPECT_TRUE(bodies_extent(poses).empty());
  const auto at = [](double x, double y) { return Eigen::Isometry3d(Eigen::Translation3d(x, y, 0.05)); };
  poses.X_WModule = {at(-0.2, 0.1), at(-0.4, 0.1)};
  poses.X_WObject = {at(1.2, -0.7)};
  const auto expect_corners = [&] {
    const std::vector<Eigen::Vector3d> corners = bodies_extent(poses);
    ASSERT_EQ(corners.size(), 4U);
    EXPECT_EQ(corners[0], Eigen::Vector3d(-0.5, -1.0, 0.0));
    EXPECT_EQ(corners[2], Eigen::Vector3d(1.5, 0.5, 0.0));
  };
  expect_corners();
  poses.X_WModule[1] = at(-0.45, 0.3);
  expect_corners();
}

TEST(Viewpoint, LookAtPutsTheTargetInTheMiddleAndTheSkyUp) {
  const Eigen::Isometry3d X_WC = look_at({1, 2, 3}, {4, 1, 0});
  const Eigen::Vector3d target = X_WC.inverse() * Eigen::Vector3d(4, 1, 0);
  EXPECT_NEAR(target.x(), 0, 1e-12);
  EXPECT_NEAR(target.y(), 0, 1e-12);
  EXPECT_GT(target.z(), 0);
  EXPECT_LT((X_WC.inverse() * Eigen::Vector3d(4, 1, 0.1)).y(), 0);  // y is down
  EXPECT_NEAR(X_WC.linear().determinant(), 1.0, 1e-12);
}

}  // namespace
}  // namespace constrictor
