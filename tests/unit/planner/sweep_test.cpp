#include "planner/sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

constexpr double kStep_m = 2.0, kSide_s = 30.0, kSpeed_m_s = 0.25;

/// A point that drives to the corners and cannot turn faster than on a circle of `radius_m`.
std::vector<Eigen::Vector2d> driven(double yaw_rad, double radius_m, double duration_s) {
  constexpr double kDt_s = 0.1;
  std::vector<Eigen::Vector2d> way;
  Sweep sweep;
  msg::RobotPose pose{};
  pose.yaw_rad = yaw_rad;
  for (double t = 0.0; t < duration_s; t += kDt_s) {
    sweep.lead(pose, t, kStep_m, kSide_s);
    const double most_rad = kSpeed_m_s * kDt_s / radius_m;
    pose.yaw_rad += std::clamp(wrap_angle(sweep.direction_rad(pose) - pose.yaw_rad), -most_rad, most_rad);
    pose.x_m += kSpeed_m_s * kDt_s * std::cos(pose.yaw_rad);
    pose.y_m += kSpeed_m_s * kDt_s * std::sin(pose.yaw_rad);
    way.emplace_back(pose.x_m, pose.y_m);
  }
  return way;
}

/// [m] from the way to the point of a square around the start that is farthest from it.
double farthest_unseen_m(const std::vector<Eigen::Vector2d>& way, double half_m) {
  double farthest_m = 0.0;
  for (double x = -half_m; x <= half_m; x += 0.5) {
    for (double y = -half_m; y <= half_m; y += 0.5) {
      double nearest_m = 1e9;
      for (const Eigen::Vector2d& p : way) nearest_m = std::min(nearest_m, (p - Eigen::Vector2d(x, y)).norm());
      farthest_m = std::max(farthest_m, nearest_m);
    }
  }
  return farthest_m;
}

TEST(SweepTest, NoPlaceAroundTheStartStaysFartherAwayThanAStep) {
  for (const double yaw_rad : {0.0, 1.0, -2.5}) {
    for (const double radius_m : {0.1, 0.8, 1.4}) {
      // The sides 1, 1, 2, 2, 3, 3, 4, 4 are 40 m long.
      EXPECT_LT(farthest_unseen_m(driven(yaw_rad, radius_m, 45.0 / kSpeed_m_s), kStep_m), kStep_m)
          << yaw_rad << ", " << radius_m;
    }
  }
}

TEST(SweepTest, TheFirstSideLeadsAheadAndTheNextOnesToTheLeft) {
  Sweep sweep;
  msg::RobotPose pose{};
  EXPECT_FALSE(sweep.leads());
  const double corners_m[][2] = {{2, 0}, {2, 2}, {-2, 2}, {-2, -2}, {4, -2}, {4, 4}, {-4, 4}};
  for (const auto& [x_m, y_m] : corners_m) {
    sweep.lead(pose, 0.0, kStep_m, kSide_s);
    EXPECT_NEAR(sweep.direction_rad(pose), std::atan2(y_m - pose.y_m, x_m - pose.x_m), 1e-12) << x_m << ", " << y_m;
    pose.x_m = x_m;
    pose.y_m = y_m;
  }
  EXPECT_TRUE(sweep.leads());
}

TEST(SweepTest, ACornerThatIsNotReachedIsGivenUp) {
  Sweep sweep;
  const msg::RobotPose pose{};
  sweep.lead(pose, 0.0, kStep_m, kSide_s);
  sweep.lead(pose, kSide_s, kStep_m, kSide_s);
  EXPECT_NEAR(sweep.direction_rad(pose), 0.0, 1e-12);
  sweep.lead(pose, kSide_s + 0.1, kStep_m, kSide_s);
  EXPECT_NEAR(sweep.direction_rad(pose), std::numbers::pi / 4.0, 1e-12);
}

TEST(SweepTest, AnotherSearchBeginsWhereTheRobotIs) {
  Sweep sweep;
  msg::RobotPose pose{};
  sweep.lead(pose, 0.0, kStep_m, kSide_s);
  sweep.end();
  EXPECT_FALSE(sweep.leads());
  pose.y_m = 5.0;
  pose.yaw_rad = 1.0;
  sweep.lead(pose, 1.0, kStep_m, kSide_s);
  EXPECT_NEAR(sweep.direction_rad(pose), 1.0, 1e-12);
}

class SweepMissionTest : public PlannerTest {
 protected:
  /// An object is seen before any line, and taken.
  void fetch_without_line() {
    see(msg::kColourGreen, msg::kBlobObject, 1.2);
    steps(4);
    ASSERT_EQ(memory_.state, MissionState::kTrackObject);
    succeed(msg::kEventObjectReached);
    succeed(msg::kEventObjectPregrasped);
    status_.carrying = true;
    succeed(msg::kEventObjectGrasped);
    see_nothing();
    ASSERT_EQ(memory_.state, MissionState::kSearchLine);
  }
};

// In 20 missions without a line, a search that alternated with moves backwards lost the object 50 times.
TEST_F(SweepMissionTest, ARobotWithAnObjectNeverSearchesBackwards) {
  fetch_without_line();
  double farthest_m = 0.0;
  for (int i = 0; i < 10000; ++i) {
    const auto wanted = step();
    ASSERT_EQ(memory_.state, MissionState::kSearchLine);
    ASSERT_FALSE(wanted && wanted->parameters.direction == msg::kDirectionBackwards) << i;
    const bool turns = last_.task == msg::kTaskRotate;
    const double bend = last_.parameters.direction == msg::kDirectionLeft    ? 1.0
                        : last_.parameters.direction == msg::kDirectionRight ? -1.0
                                                                             : 0.0;
    face(pose_.yaw_rad + bend * (turns ? 0.006 : 0.003));
    pose_.x_m += 0.005 * std::cos(pose_.yaw_rad);
    pose_.y_m += 0.005 * std::sin(pose_.yaw_rad);
    farthest_m = std::max(farthest_m, std::hypot(pose_.x_m, pose_.y_m));
  }
  // A robot that drives 50 m straight on is 50 m away; the fifth pair of sides of the square ends at 3 steps.
  EXPECT_LT(farthest_m, 12.0);
  EXPECT_GT(farthest_m, 3.0);
}

TEST_F(SweepMissionTest, ADistantZoneIsRememberedWhereThereIsNoLine) {
  map_.object_count = 1;
  map_.objects[0] = {1, msg::kColourGreen, msg::kBlobZone, 0.0, 9.0, 0.3, 0.0, 0.03, false, false, 0, 0.0};
  fetch_without_line();
  steps(2);
  EXPECT_EQ(last_.task, msg::kTaskRotate);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionLeft);
  face(std::numbers::pi / 2.0);
  steps(2);
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionForwards);
}

}  // namespace
}  // namespace constrictor
