// Cross-track distance and planar poses compared with geometry.
#include "sim/report/statistics.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace constrictor::report {
namespace {

std::vector<Eigen::Vector2d> arc(double radius_m, int segments) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = std::numbers::pi * i / segments;
    points.emplace_back(radius_m * std::cos(angle), radius_m * std::sin(angle));
  }
  return points;
}

TEST(CrossTrack, OffsetPathHasItsOffset) {
  const auto line = arc(1.5, 400);
  RootMeanSquare statistics;
  for (int i = 1; i < 100; ++i) {
    const double angle = std::numbers::pi * i / 100;
    const auto distance = cross_track_m(1.57 * Eigen::Vector2d(std::cos(angle), std::sin(angle)), line);
    ASSERT_TRUE(distance);
    statistics.add(*distance);
  }
  // A chord of the polyline lies at most r (1 - cos(pi / 800)) inside its arc.
  EXPECT_NEAR(statistics.rms(), 0.07, 2e-5);
  EXPECT_NEAR(statistics.max(), 0.07, 2e-5);
}

TEST(CrossTrack, SineOffsetHasItsRootMeanSquare) {
  RootMeanSquare statistics;
  for (int i = 0; i < 1000; ++i) {
    statistics.add(
        *cross_track_m({1.0 + 0.002 * i, 0.1 * std::sin(2 * std::numbers::pi * i / 100)}, {{0, 0}, {10, 0}}));
  }
  EXPECT_NEAR(statistics.rms(), 0.1 / std::sqrt(2.0), 1e-12);
}

TEST(Effort, ConstantPowerOnACircleHasItsWorkItsPathAndItsCostOfTransport) {
  constexpr double kPower_w = 30.0, kSpeed_m_s = 0.2, kRadius_m = 1.5, kMass_kg = 12.0, kPeriod_s = 0.02;
  Effort effort;
  EXPECT_TRUE(std::isnan(effort.cost_of_transport(kMass_kg)));
  for (int tick = 0; tick <= 3000; ++tick) {
    if (tick > 0) effort.add_work(kPower_w, kPeriod_s);
    const double angle = kSpeed_m_s * tick * kPeriod_s / kRadius_m;
    // It trembles by 1 mm, which must not count as path.
    const double radius_m = kRadius_m + (tick % 2 == 0 ? 0.0 : 0.001);
    effort.add_centre(radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)), tick * kPeriod_s);
  }
  EXPECT_NEAR(effort.work_j, kPower_w * 60.0, 1e-6);
  EXPECT_NEAR(effort.distance_m, kSpeed_m_s * 60.0, 0.01);
  EXPECT_NEAR(effort.cost_of_transport(kMass_kg), kPower_w / (kMass_kg * 9.81 * kSpeed_m_s), 2e-3);
}

TEST(CrossTrack, BeyondTheEndsThereIsNone) {
  const std::vector<Eigen::Vector2d> line{{0, 0}, {1, 0}, {2, 1}};
  EXPECT_FALSE(cross_track_m({-0.5, 0.1}, line));
  EXPECT_FALSE(cross_track_m({2.5, 1.5}, line));
  EXPECT_DOUBLE_EQ(*cross_track_m({0.5, 0.3}, line), 0.3);
  EXPECT_NEAR(*cross_track_m({1.1, -0.2}, line), std::hypot(0.1, 0.2), 1e-12);  // outside a corner: to the corner
  EXPECT_FALSE(cross_track_m({0, 0}, {}));
}

TEST(PlanarPose, RelativePoseUndoesTheFirst) {
  const PlanarPose a{{1.0, 2.0}, 0.5};
  const PlanarPose b{{1.0 + 3.0 * std::cos(0.5), 2.0 + 3.0 * std::sin(0.5)}, 0.5 + 3.0};
  const PlanarPose relative = relative_pose(a, b);
  EXPECT_NEAR(relative.p.x(), 3.0, 1e-12);
  EXPECT_NEAR(relative.p.y(), 0.0, 1e-12);
  EXPECT_NEAR(relative.yaw_rad, 3.0, 1e-12);
  const PlanarPose back = relative_pose(b, a);
  EXPECT_NEAR(back.p.x(), -3.0 * std::cos(3.0), 1e-12);
  EXPECT_NEAR(back.p.y(), 3.0 * std::sin(3.0), 1e-12);
  EXPECT_NEAR(back.yaw_rad, -3.0, 1e-12);
  EXPECT_NEAR(wrap_angle(4.0), 4.0 - 2 * std::numbers::pi, 1e-12);
}

TEST(RootMeanSquare, IsNotANumberBeforeTheFirst) {
  EXPECT_TRUE(std::isnan(RootMeanSquare{}.rms()));
  EXPECT_TRUE(std::isnan(RootMeanSquare{}.max()));
}

}  // namespace
}  // namespace constrictor::report
