#include "sim/scenario_loader/line_path.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace constrictor {
namespace {

double length_of(const std::vector<Eigen::Vector2d>& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

TEST(LinePath, AQuarterCircleEndsAtItsRadius) {
  const double radius = 1.3;
  const LinePath path = make_line_path({}, {{radius * std::numbers::pi / 2, 1 / radius}}, 512);
  EXPECT_NEAR((path.end.p - Eigen::Vector2d(radius, radius)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(path.end.yaw_rad, std::numbers::pi / 2, 1e-12);
  for (const Eigen::Vector2d& point : path.points_m) {
    EXPECT_NEAR((point - Eigen::Vector2d(0, radius)).norm(), radius, 1e-12);
  }
}

TEST(LinePath, SegmentsJoinWithContinuousHeading) {
  const LinePath path = make_line_path({{1, 2}, 0.5}, {{0.7, 0}, {1.0, 0.8}, {1.5, -0.9}, {0.4, 0}}, 512);
  EXPECT_NEAR(length_of(path.points_m), 3.6, 0.001);
  for (std::size_t i = 2; i < path.points_m.size(); ++i) {
    const Eigen::Vector2d a = path.points_m[i - 1] - path.points_m[i - 2];
    const Eigen::Vector2d b = path.points_m[i] - path.points_m[i - 1];
    EXPECT_LT(std::acos(std::min(1.0, a.dot(b) / (a.norm() * b.norm()))), 0.9 * 0.021);
  }
  EXPECT_NEAR(path.end.yaw_rad, 0.5 + 0.8 - 1.5 * 0.9, 1e-12);
}

TEST(LinePath, HasAtMostAsManyPointsAsTheMessage) {
  EXPECT_LE(make_line_path({}, std::vector<LineSegment>(30, {1.37, 0.2}), 512).points_m.size(), 512U);
}

TEST(LinePath, FramesPlacePointsAheadAndLeft) {
  const PlanarPose frame{{1, 1}, std::numbers::pi / 2};
  EXPECT_NEAR(((frame.p + turned({2, 0.5}, frame.yaw_rad)) - Eigen::Vector2d(0.5, 3)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace constrictor
