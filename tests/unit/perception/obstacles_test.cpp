// Obstacles without a colour of interest, in the scenes of an independent ray caster.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "lit_scene.hpp"

namespace constrictor {
namespace {

using testing::Arc;
using testing::Conditions;
using testing::Round;
using testing::Scene;

const Conditions kLights[] = {
    {1.0, 0.35, 0.0, false, {}},
    {0.5, 0.35, 0.02, false, {0.0, 0.02, 0.4, 0.035}},
    {1.4, 0.3, 0.03, true, {0.03, -0.02, -2.0, 0.035}},
    {0.7, 0.4, 0.02, true, {-0.04, 0.04, 1.0, 0.035}},
};

/// A light behind the camera: shadows fall away from it.
const Eigen::Vector3d kBehind{-0.5, 0.0, 0.85};

std::vector<Eigen::Vector2d> obstacles_in(const Scene& scene, const Conditions& c) {
  const perception::Percepts percepts = look(scene, c);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < percepts.objects.obstacle_count; ++i)
    points.emplace_back(percepts.objects.obstacle_x_m[i], percepts.objects.obstacle_y_m[i]);
  return points;
}

/// [m] ground that a pixel and a half covers along the line of sight, for a camera of this height and f = 160 pixels.
double tolerance_m(double range_m) { return 0.015 + 1.5 * (range_m * range_m + 0.0072) / (160.0 * 0.085); }

TEST(Obstacles, GreyPegsAreSeenWhereTheyStand) {
  for (const Conditions& c : kLights) {
    for (const double height : {0.13, 0.2}) {
      for (const double range : {0.45, 0.6, 0.9}) {
        for (const double bearing : {-0.5, 0.0, 0.35}) {
          const Eigen::Vector2d sight(std::cos(bearing), std::sin(bearing));
          Scene scene;
          scene.light = kBehind;
          scene.rounds = {Round{msg::kColourUnknown, (range + 0.04) * sight, 0.04, height}};
          SCOPED_TRACE(describe(c) + ", range " + std::to_string(range) + ", bearing " + std::to_string(bearing));
          const auto points = obstacles_in(scene, c);
          ASSERT_FALSE(points.empty());
          for (const Eigen::Vector2d& p : points)
            EXPECT_NEAR((p - scene.rounds[0].centre).norm(), 0.04, tolerance_m(range)) << p.transpose();
        }
      }
    }
  }
}

// A shadow that falls towards the camera may have the shade of the dark side that throws it. The obstacle then seems to
// be nearer, by the length of the shadow at most.
TEST(Obstacles, AShadowTowardsTheCameraCountsAsAPartOfThePeg) {
  constexpr double kHeight_m = 0.2, kRange_m = 0.7;
  Scene scene;
  scene.light = Eigen::Vector3d(0.5, 0.0, 0.85);
  scene.rounds = {Round{msg::kColourUnknown, {kRange_m + 0.04, 0.0}, 0.04, kHeight_m}};
  const auto points = obstacles_in(scene, kLights[0]);
  ASSERT_FALSE(points.empty());
  const double shadow_m = kHeight_m * 0.5 / 0.85;
  for (const Eigen::Vector2d& p : points) {
    EXPECT_LT(p.norm(), kRange_m + tolerance_m(kRange_m));
    EXPECT_GT(p.norm(), kRange_m - shadow_m - tolerance_m(kRange_m));
  }
}

// The surface of a cylinder of 3 m radius is nearly a wall.
TEST(Obstacles, AWallIsASeriesOfPoints) {
  for (const Conditions& c : kLights) {
    for (const double side : {-1.0, 1.0}) {
      SCOPED_TRACE(describe(c));
      Scene scene;
      scene.light = kBehind;
      scene.rounds = {Round{msg::kColourUnknown, {0.6, side * 3.35}, 3.0, 0.15}};
      const auto points = obstacles_in(scene, c);
      ASSERT_GT(points.size(), 5U);
      double nearest_m = 9.0, farthest_m = 0.0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        EXPECT_NEAR((points[i] - scene.rounds[0].centre).norm(), 3.0, tolerance_m(points[i].norm()));
        nearest_m = std::min(nearest_m, points[i].norm());
        farthest_m = std::max(farthest_m, points[i].norm());
        if (i > 0) {
          EXPECT_GE((points[i] - points[i - 1]).norm(), 0.0499);
        }
      }
      EXPECT_LT(nearest_m, 0.6);
      EXPECT_GT(farthest_m, 0.9);
    }
  }
}

TEST(Obstacles, NothingIsOneThatHasAColourOrLiesFlat) {
  for (const Conditions& c : kLights) {
    for (const double height : {0.06, 0.15, 0.4}) {
      for (const double range : {0.3, 0.6, 1.0}) {
        SCOPED_TRACE(describe(c) + ", height " + std::to_string(height) + ", range " + std::to_string(range));
        Scene scene;
        scene.line = Arc{};
        scene.rounds = {Round{msg::kColourRed, {range + 0.3, 0.3}, 0.3},
                        Round{msg::kColourGreen, {range, -0.2}, 0.085, height},
                        Round{msg::kColourRed, {range + 0.3, 0.3}, 0.085, height},
                        Round{msg::kColourYellow, {range + 0.1, 0.05}, 0.05, height}};
        for (const auto& p : obstacles_in(scene, c)) ADD_FAILURE() << p.transpose();
      }
    }
  }
  Scene glaring;
  glaring.light_intensity = 4.0;
  EXPECT_TRUE(obstacles_in(glaring, {4.0, 0.35, 0.0, false, {}}).empty()) << "the ground is as white as can be";
  EXPECT_TRUE(obstacles_in({}, {0.0, 0.0, 0.0, false, {}}).empty()) << "dark ground";
}

// The foot of what stands behind an object is hidden: it must not be taken for more distant than it is.
TEST(Obstacles, AHiddenFootGivesNoPoint) {
  for (const Conditions& c : kLights) {
    SCOPED_TRACE(describe(c));
    Scene scene;
    scene.rounds = {Round{msg::kColourUnknown, {0.75, 0.0}, 0.04, 0.3}, Round{msg::kColourRed, {0.5, 0.0}, 0.08, 0.06}};
    for (const auto& p : obstacles_in(scene, c)) ADD_FAILURE() << p.transpose();
  }
}

TEST(Obstacles, WhatIsLowerThanTheCameraIsNotSeen) {
  Scene scene;
  scene.rounds = {Round{msg::kColourUnknown, {0.6, 0.0}, 0.04, 0.07}};
  EXPECT_TRUE(obstacles_in(scene, kLights[0]).empty());
  scene.rounds[0].height_m = 0.11;
  EXPECT_FALSE(obstacles_in(scene, kLights[0]).empty()) << "a higher one is seen";
}

TEST(Obstacles, TheRangeIsAParameter) {
  perception::PerceptionConfig config;
  config.obstacle_max_range_m = 0.5;
  Scene scene;
  scene.rounds = {Round{msg::kColourUnknown, {0.4, 0.2}, 0.04, 0.2},
                  Round{msg::kColourUnknown, {0.8, -0.2}, 0.04, 0.2}};
  const auto seen = [&] {
    perception::LineAndBlobDetector detector(config);
    const msg::CameraInfo info = testing::camera_info();
    const testing::Head head;
    const perception::GroundCamera camera(info, testing::orientation(head), head.height_m);
    const auto percepts = detector.detect(testing::draw(scene, info, head), camera, msg::kColourBlue);
    bool near = false, far = false;
    for (int i = 0; i < percepts.objects.obstacle_count; ++i)
      (percepts.objects.obstacle_y_m[i] > 0.0 ? near : far) = true;
    return std::pair(near, far);
  };
  EXPECT_EQ(seen(), std::pair(true, false));
  config.obstacle_max_range_m = 1.2;
  EXPECT_EQ(seen(), std::pair(true, true));
  config.obstacle_max_range_m = 0.0;
  EXPECT_EQ(seen(), std::pair(false, false));
}

}  // namespace
}  // namespace constrictor
