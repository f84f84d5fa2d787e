// The pose filter compared with motions that are known analytically.
#include "guidance/pose_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace constrictor {
namespace {

using namespace guidance;

const Eigen::Matrix2d kSeen = 0.02 * 0.02 * Eigen::Matrix2d::Identity();  // noise of a percept

/// A robot that drives along x towards a landmark, with a scale that it does not know.
struct Approach {
  PoseFilterState state;
  PoseFilter filter{state};
  Eigen::Vector2d landmark, truth{0.0, 0.0};

  Approach(double scale_sd, const Eigen::Vector2d& landmark_M) : landmark(landmark_M) {
    filter.forget_scale(scale_sd);
    filter.add(landmark, kSeen);
  }
  /// Drives ahead for some steps of 0.01 m that odometry takes for `factor` times as long.
  void drive(int steps, double factor) {
    for (int k = 0; k < steps; ++k) {
      const Eigen::Vector2d step(0.01, 0.0);
      truth += step;
      filter.predict(factor * step, 0.0, Eigen::Vector3d(1e-7, 1e-7, 1e-9).asDiagonal(), {factor * step, 0.0, 0.0});
    }
  }
  void see() { filter.observe(0, landmark - truth, kSeen); }
};

TEST(PoseFilter, ALandmarkAheadTeachesTheScaleOfTheDrift) {
  // 2 m towards a landmark, then 1 m without a sight of it. Odometry takes each step for 25 % too long.
  Approach robot(0.25, {4.0, 0.3});
  for (int image = 0; image < 20; ++image) {
    robot.drive(10, 1.25);
    robot.see();
  }
  EXPECT_NEAR(robot.filter.scale(), 1.0 / 1.25, 0.03);
  EXPECT_LT(robot.filter.scale_sd(), 0.03);
  const double seen_m = robot.filter.pose().p.x() - robot.truth.x();
  robot.drive(100, 1.25);
  EXPECT_NEAR(robot.filter.pose().p.x() - robot.truth.x(), seen_m, 0.04);  // 0.25 m without the scale
}

TEST(PoseFilter, OnlyTheDriftIsScaled) {
  PoseFilterState state;
  state.mean[3] = 0.8;
  PoseFilter filter(state);
  const Eigen::Vector2d moved = filter.predict({0.10, 0.02}, 0.0, Eigen::Matrix3d::Zero(), {{0.05, -0.01}, 0.0, 0.0});
  EXPECT_NEAR(moved.x(), 0.10 - 0.2 * 0.05, 1e-12);
  EXPECT_NEAR(moved.y(), 0.02 + 0.2 * 0.01, 1e-12);
  EXPECT_NEAR(filter.pose().p.x(), moved.x(), 1e-12);
  EXPECT_NEAR(filter.pose().p.y(), moved.y(), 1e-12);
}

TEST(PoseFilter, TheSpreadOfTheScaleSpreadsThePlace) {
  PoseFilterState state;
  PoseFilter filter(state);
  filter.forget_scale(0.1);
  for (int k = 0; k < 100; ++k) {
    filter.predict({0.01, 0.0}, 0.0, Eigen::Matrix3d::Zero(), {{0.01, 0.0}, 0.0, 0.0});
  }
  EXPECT_NEAR(std::sqrt(filter.pose_covariance()(0, 0)), 0.1 * 1.0, 1e-9);  // of the metre driven
  EXPECT_NEAR(filter.pose_covariance()(1, 1), 0.0, 1e-12);
}

TEST(PoseFilter, TheScaleIsAGaussMarkovProcess) {
  // Without percepts the mean decays to 1, and the variance grows to that of the process, with the known exponentials.
  constexpr double kPeriod_s = 0.02, kTime_s = 5.0, kSd = 0.2;
  PoseFilterState state;
  state.mean[3] = 0.7;
  PoseFilter filter(state);
  const ScaledDrift process{{0.0, 0.0}, 1.0 - std::exp(-kPeriod_s / kTime_s), kSd};
  for (int k = 1; k <= 1000; ++k) {
    filter.predict({0.0, 0.0}, 0.0, Eigen::Matrix3d::Zero(), process);
    const double t_s = k * kPeriod_s;
    ASSERT_NEAR(filter.scale(), 1.0 - 0.3 * std::exp(-t_s / kTime_s), 1e-9);
    ASSERT_NEAR(filter.scale_sd(), kSd * std::sqrt(1.0 - std::exp(-2.0 * t_s / kTime_s)), 1e-9);
  }
}

TEST(PoseFilter, ALoadMakesTheScaleUnknownAgain) {
  Approach robot(0.25, {4.0, 0.0});
  robot.drive(100, 1.25);
  robot.see();
  ASSERT_LT(robot.filter.scale(), 0.9);
  const Eigen::Matrix3d before = robot.filter.pose_covariance();
  robot.filter.forget_scale(0.1);
  EXPECT_EQ(robot.filter.scale(), 1.0);
  EXPECT_DOUBLE_EQ(robot.filter.scale_sd(), 0.1);
  EXPECT_EQ(robot.filter.pose_covariance(), before);
  // What was driven before tells nothing about the new scale.
  robot.filter.observe(0, Eigen::Vector2d(3.9, 0.0) - robot.truth, kSeen);
  EXPECT_DOUBLE_EQ(robot.filter.scale(), 1.0);
}

TEST(PoseFilter, AWrongPerceptDoesNotTurnTheMotionRound) {
  Approach robot(0.5, {4.0, 0.0});
  robot.drive(100, 1.0);
  robot.filter.observe(0, {7.0, 0.0}, kSeen);  // as if the robot had driven backwards
  EXPECT_GT(robot.filter.scale(), 0.0);
  const double x_m = robot.filter.pose().p.x();
  robot.drive(10, 1.0);
  EXPECT_GT(robot.filter.pose().p.x(), x_m);
}

TEST(PoseFilter, LandmarksSeenAgainCorrectTheDrift) {
  // A square of 2 m. The odometry takes each step for 5 % too long and each turn for 2 % too far.
  PoseFilterState state;
  PoseFilter filter(state);
  const Eigen::Vector2d landmarks[] = {{1.0, 0.8}, {1.5, -0.6}};
  const Eigen::Matrix2d noise = 0.02 * 0.02 * Eigen::Matrix2d::Identity();
  PlanarPose truth;
  filter.add(landmarks[0], noise);
  filter.add(landmarks[1], noise);
  for (int side = 0; side < 4; ++side) {
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector2d step(0.02, 0.0);
      const double turn = k < 50 ? std::numbers::pi / 100.0 : 0.0;
      const Eigen::Vector2d p = to_parent(truth, turned(step, 0.5 * turn));
      truth = {p, wrap_angle(truth.yaw_rad + turn)};
      filter.predict(1.05 * step, 1.02 * turn, Eigen::Vector3d(1e-5, 1e-6, 1e-5).asDiagonal());
    }
  }
  const double before = (filter.pose().p - truth.p).norm();
  const double spread = filter.pose_covariance().trace();
  for (int k = 0; k < 5; ++k) {
    for (std::size_t i = 0; i < 2; ++i) filter.observe(i, truth.to_local(landmarks[i]), noise);
  }
  EXPECT_GT(before, 0.1);
  EXPECT_LT((filter.pose().p - truth.p).norm(), 0.02);
  EXPECT_LT(std::abs(wrap_angle(filter.pose().yaw_rad - truth.yaw_rad)), 0.02);
  EXPECT_LT(filter.pose_covariance().trace(), spread);
  const Eigen::Vector2d second = filter.landmark(1);
  filter.remove(0);
  EXPECT_EQ(filter.landmark_count(), 1u);
  EXPECT_EQ(filter.landmark(0), second);
}

}  // namespace
}  // namespace constrictor
