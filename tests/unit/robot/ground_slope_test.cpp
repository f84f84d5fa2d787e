// The slope that the attitude of the head shows, against rotations composed here.
#include "robot/ground_slope.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

namespace constrictor {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kLevel_rad = 0.015;
constexpr double kShare = 0.02 / 4.0;  // 50 attitudes a second, time constant 4 s

msg::Quaternion message(const Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }
Quaterniond quaternion(const msg::Quaternion& q) { return {q.w, q.x, q.y, q.z}; }

/// A slope that rises by `angle_rad` towards the left of the level frame's x axis.
Quaterniond slope(double angle_rad) { return Quaterniond(AngleAxisd(angle_rad, Vector3d::UnitX())); }

/// The head at tick k: it turns about the normal of the ground, and rocks.
Quaterniond on_ground(int k) {
  return AngleAxisd(0.01 * k, Vector3d::UnitZ()) * AngleAxisd(0.02 * std::sin(0.3 * k), Vector3d::UnitY()) *
         AngleAxisd(0.02 * std::cos(0.41 * k), Vector3d::UnitX());
}

TEST(GroundSlope, IsFoundWhileTheHeadTurnsAndRocks) {
  for (const double angle_rad : {0.03, 0.1}) {
    GroundSlope found;
    for (int k = 0; k < 1500; ++k) found.learn(message(slope(angle_rad) * on_ground(k)), kShare);
    EXPECT_NEAR(found.angle_rad(), angle_rad, 1e-3);
    for (int k = 1500; k < 1520; ++k) {
      const Quaterniond relative =
          quaternion(found.relative_to_ground(message(slope(angle_rad) * on_ground(k)), kLevel_rad));
      const Vector3d up = relative * Vector3d::UnitZ(), wanted = on_ground(k) * Vector3d::UnitZ();
      EXPECT_NEAR((up - wanted).norm(), 0.0, 2e-3) << "the head's attitude relative to the ground";
    }
  }
}

TEST(GroundSlope, TheFirstAttitudeIsEnough) {
  GroundSlope found;
  EXPECT_EQ(found.angle_rad(), 0.0);
  found.learn(message(slope(0.05)), kShare);
  EXPECT_NEAR(found.angle_rad(), 0.05, 1e-9);
}

TEST(GroundSlope, TheMeanFollowsAChangeWithItsTimeConstant) {
  GroundSlope found;
  for (int k = 0; k < 4000; ++k) found.learn(message(slope(0.0)), kShare);
  for (int k = 0; k < 200; ++k) found.learn(message(slope(0.1)), kShare);  // one time constant
  EXPECT_NEAR(std::sin(found.angle_rad()), std::sin(0.1) * (1.0 - std::exp(-1.0)), 1e-3);
}

TEST(GroundSlope, OnLevelGroundTheAttitudeStaysAsItIs) {
  GroundSlope found;
  for (int k = 0; k < 1000; ++k) {
    const msg::Quaternion attitude = message(on_ground(k));
    found.learn(attitude, kShare);
    if (k < 50) continue;  // the mean of a few attitudes is not yet level
    const msg::Quaternion relative = found.relative_to_ground(attitude, kLevel_rad);
    ASSERT_TRUE(relative.w == attitude.w && relative.x == attitude.x && relative.y == attitude.y &&
                relative.z == attitude.z)
        << "tick " << k;
  }
}

TEST(GroundSlope, GravityAlongTheGroundPointsDownhill) {
  for (const double angle_rad : {0.03, 0.1}) {
    GroundSlope found;
    for (int k = 0; k < 1500; ++k) found.learn(message(slope(angle_rad) * on_ground(k)), kShare);
    const Eigen::Vector2d downhill = found.downhill(kLevel_rad);  // the ground rises to the left
    EXPECT_NEAR(downhill.x(), 0.0, 1e-3);
    EXPECT_NEAR(downhill.y(), -std::sin(angle_rad), 1e-3);
  }
  GroundSlope level;
  for (int k = 0; k < 1000; ++k) level.learn(message(slope(0.01)), kShare);
  EXPECT_EQ(level.downhill(kLevel_rad).norm(), 0.0);
}

TEST(GroundSlope, DoesNotGoToAndFroAtTheBound) {
  const auto inclined_at = [](GroundSlope& ground, double angle_rad) {
    for (int k = 0; k < 4000; ++k) ground.learn(message(slope(angle_rad)), kShare);
    const msg::Quaternion attitude = message(slope(angle_rad));
    return ground.relative_to_ground(attitude, kLevel_rad).x != attitude.x;
  };
  GroundSlope ground;
  EXPECT_FALSE(inclined_at(ground, 0.0149));
  EXPECT_TRUE(inclined_at(ground, 0.0151));
  EXPECT_TRUE(inclined_at(ground, 0.0101)) << "still a slope";
  EXPECT_FALSE(inclined_at(ground, 0.0099));
  EXPECT_FALSE(inclined_at(ground, 0.0149)) << "still level";
}

TEST(GroundSlope, AHeadThatDoesNotLieOnTheGroundTeachesNothing) {
  GroundSlope found;
  for (int k = 0; k < 500; ++k) found.learn(message(slope(0.03)), kShare);
  for (int k = 0; k < 500; ++k) found.learn(message(slope(GroundSlope::kLying_rad + 0.01)), kShare);
  for (int k = 0; k < 500; ++k) found.learn(message(slope(3.0)), kShare);  // on its back
  EXPECT_NEAR(found.angle_rad(), 0.03, 1e-9);
}

}  // namespace
}  // namespace constrictor
