// The line of the map ahead of the head, compared with the equation of a straight line and of a circle.
#include "navigation/mapped_line.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace constrictor {
namespace {

constexpr double kLookahead_m = 0.6, kAside_m = 1.0, kReach_m = 2.0;

void add(msg::FieldMap& map, double x_m, double y_m) {
  map.line_x_m[map.line_point_count] = x_m;
  map.line_y_m[map.line_point_count++] = y_m;
}

/// The x axis of M from 0 to 5 m.
msg::FieldMap straight_line() {
  msg::FieldMap map{};
  for (int i = 0; i <= 100; ++i) add(map, 0.05 * i, 0.0);
  return map;
}

TEST(MappedLine, LiesAheadInTheHeadsFrameWhicheverWayTheHeadPoints) {
  const msg::FieldMap map = straight_line();
  for (const double yaw_rad : {-0.3, 0.0, 0.2}) {
    for (const double y_m : {-0.4, 0.0, 0.3}) {
      // The point at which the x axis crosses the line x_H = kLookahead_m of the head.
      const double expected_m = -(y_m + kLookahead_m * std::sin(yaw_rad)) / std::cos(yaw_rad);
      for (const PlanarPose& X_MH : {PlanarPose{{2.0, y_m}, yaw_rad}, PlanarPose{{3.0, -y_m}, yaw_rad + M_PI}}) {
        const std::optional<PlanarPose> X_HL = mapped_line_H(map, X_MH, kLookahead_m, kAside_m, kReach_m);
        ASSERT_TRUE(X_HL);
        EXPECT_EQ(X_HL->p.x(), kLookahead_m);
        EXPECT_NEAR(X_HL->p.y(), expected_m, 0.06);
        EXPECT_NEAR(X_HL->yaw_rad, -yaw_rad, 0.15);
      }
    }
  }
}

TEST(MappedLine, IsUnknownWhereThereIsNoLineOrItDoesNotGoOn) {
  const msg::FieldMap map = straight_line();
  const auto known = [&](double x_m, double y_m, double yaw_rad) {
    return mapped_line_H(map, {{x_m, y_m}, yaw_rad}, kLookahead_m, kAside_m, kReach_m).has_value();
  };
  EXPECT_FALSE(mapped_line_H(msg::FieldMap{}, {}, kLookahead_m, kAside_m, kReach_m));
  EXPECT_TRUE(known(2.0, 0.9, 0.0));
  EXPECT_FALSE(known(2.0, 2.1, 0.0)) << "farther than 2 m";
  EXPECT_FALSE(known(4.3, 0.0, 0.0)) << "it ends just there";
  EXPECT_FALSE(known(6.0, 0.0, 0.0)) << "it lies behind";
}

TEST(MappedLine, TheWayToALineThatBeginsAheadCountsAsALine) {
  const msg::FieldMap map = straight_line();
  const auto line_of = [&](double x_m, double y_m) {
    return mapped_line_H(map, {{x_m, y_m}, 0.0}, kLookahead_m, kAside_m, kReach_m);
  };
  const auto ahead = line_of(-1.5, -0.5);  // the origin lies 1.5 m ahead and 0.5 m to the left
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->p.y() / ahead->p.x(), 0.5 / 1.5, 1e-9);
  EXPECT_NEAR(ahead->yaw_rad, std::atan2(0.5, 1.5), 1e-9);
  EXPECT_FALSE(line_of(-2.1, 0.0)) << "farther than 2 m";
  const auto aside = line_of(2.0, -1.2);  // farther aside than 1 m: the way leads there slantwise
  ASSERT_TRUE(aside);
  EXPECT_GT(aside->yaw_rad, 0.7);
  // A line that crosses the way is followed neither to the left nor to the right: the way to it counts.
  const auto crossed = mapped_line_H(map, {{2.0, -0.8}, M_PI / 2}, kLookahead_m, kAside_m, kReach_m);
  ASSERT_TRUE(crossed);
  EXPECT_NEAR(crossed->p.y(), 0.0, 0.03);
}

// The map has a line also for a head that points across it; without one, a robot with an object would leave the bend.
TEST(MappedLine, LeadsAHeadThatPointsOutOfABendBackToTheLine) {
  const msg::FieldMap map = straight_line();
  for (const double side : {1.0, -1.0}) {
    for (const double yaw_rad : {0.9, 1.2}) {  // the head is on the line and points away from it
      const auto X_HL = mapped_line_H(map, {{2.0, 0.0}, side * yaw_rad}, kLookahead_m, kAside_m, kReach_m);
      ASSERT_TRUE(X_HL) << yaw_rad;
      EXPECT_NEAR(X_HL->p.norm(), kLookahead_m, 0.11) << yaw_rad;
      EXPECT_NEAR(X_HL->yaw_rad, -side * yaw_rad, 1e-9) << yaw_rad;
    }
  }
}

TEST(MappedLine, FollowsABend) {
  msg::FieldMap map{};  // a circle of radius 2 m round (0, 2), from the origin to the left
  for (double angle = 0.0; angle < 1.5; angle += 0.025) add(map, 2.0 * std::sin(angle), 2.0 - 2.0 * std::cos(angle));
  const double expected_m = 2.0 - std::sqrt(4.0 - kLookahead_m * kLookahead_m);
  const std::optional<PlanarPose> X_HL = mapped_line_H(map, {}, kLookahead_m, kAside_m, kReach_m);
  ASSERT_TRUE(X_HL);
  EXPECT_NEAR(X_HL->p.y(), expected_m, 0.06);
  // The chord over the next 0.4 m turns by the mean of the angles at its ends.
  EXPECT_NEAR(X_HL->yaw_rad, 0.5 * (std::asin(0.3) + std::asin(0.5)), 0.2);
}

}  // namespace
}  // namespace constrictor
