// Ground that has the colour of an object, in images of the simulator's renderer.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lit_scene.hpp"
#include "perception/ground_colour.hpp"
#include "rendered_scene.hpp"

namespace constrictor {
namespace {

using perception::GroundColour;
using testing::Arc;
using testing::find;
using testing::kDegree;
using testing::RenderedLight;
using testing::Round;

const Eigen::Vector3d kGreenGround{0.10, 0.30, 0.10};

const RenderedLight kLit[] = {
    {{0.3, -0.4, 0.85}, 1.0, 0.35, 0.01, {}},
    {{-0.6, 0.5, 0.5}, 0.6, 0.3, 0.02, {0.02, -0.02, 0.7, 0.035}},
    {{0.1, 0.1, 1.0}, 1.5, 0.35, 0.02, {-0.03, 0.02, 0.0, 0.035}},
    {{0.8, 0.2, 0.4}, 0.8, 0.3, 0.02, {0.0, 0.04, 2.0, 0.035}},
};

void expect_round(const perception::Percepts& percepts, const Round& r, double range_error = 0.06) {
  SCOPED_TRACE("colour " + std::to_string(r.colour) + " at range " + std::to_string(r.centre.norm()));
  const msg::Blob* blob = find(percepts, r.colour, r.height_m > 0.0 ? msg::kBlobObject : msg::kBlobZone);
  ASSERT_NE(blob, nullptr);
  EXPECT_NEAR(blob->bearing_rad, std::atan2(r.centre.y(), r.centre.x()), 1.5 * kDegree);
  const double range_m = r.centre.norm() - r.radius_m;
  EXPECT_NEAR(blob->range_m, range_m, range_error * range_m);
  if (blob->cut_left || blob->cut_right) return;
  EXPECT_NEAR(blob->width_m, 2.0 * r.radius_m, 0.03);
}

TEST(ColouredGround, BareGroundIsNoPercept) {
  for (const RenderedLight& lit : kLit) {
    for (const Eigen::Vector3d& colour : {kGreenGround, Eigen::Vector3d(0.4, 0.1, 0.1), Eigen::Vector3d(0.1, 0.15, 0.4),
                                          Eigen::Vector3d(0.4, 0.3, 0.05)}) {
      SCOPED_TRACE(describe(lit));
      testing::Scene scene;
      scene.ground_colour = colour;
      const perception::Percepts percepts = look(scene, lit);
      EXPECT_TRUE(percepts.ground.coloured());
      EXPECT_FALSE(percepts.line.visible);
      EXPECT_EQ(percepts.objects.blob_count, 0);
      EXPECT_EQ(percepts.objects.obstacle_count, 0);
    }
  }
}

// Noise then makes one pixel green and the next one colourless.
TEST(ColouredGround, ItsHueMayLieAtTheBoundOfAColour) {
  for (const RenderedLight& lit : kLit) {
    SCOPED_TRACE(describe(lit));
    testing::Scene scene;
    scene.ground_colour = {0.04, 0.28, 0.20};  // 165 degrees
    scene.rounds = {Round{msg::kColourGreen, {1.0, 0.3}, 0.09, 0.15}, Round{msg::kColourGreen, {0.7, -0.25}, 0.15}};
    const perception::Percepts percepts = look(scene, lit);
    EXPECT_EQ(percepts.ground.colour, msg::kColourGreen);
    EXPECT_EQ(percepts.objects.blob_count, 2);
    for (const Round& r : scene.rounds) expect_round(percepts, r);
  }
}

TEST(ColouredGround, ThingsOfItsHueAreFoundByTheirSaturation) {
  for (const RenderedLight& lit : kLit) {
    SCOPED_TRACE(describe(lit));
    testing::Scene scene;
    scene.ground_colour = kGreenGround;
    scene.line = Arc{{-0.1, 0.0}, 0.0, 0.3};
    scene.rounds = {Round{msg::kColourGreen, {1.0, 0.5}, 0.09, 0.15}, Round{msg::kColourRed, {1.1, -0.35}, 0.08, 0.15},
                    Round{msg::kColourGreen, {0.7, -0.5}, 0.15}, Round{msg::kColourYellow, {0.55, 0.3}, 0.1}};
    const perception::Percepts percepts = look(scene, lit);
    EXPECT_EQ(percepts.ground.colour, msg::kColourGreen);
    EXPECT_TRUE(percepts.line.visible);
    EXPECT_EQ(percepts.objects.blob_count, 4);
    for (const Round& r : scene.rounds) expect_round(percepts, r);
  }
}

TEST(ColouredGround, AnObjectOfItsTintIsFoundAboveTheHorizonAndByItsShade) {
  for (const RenderedLight& lit : kLit) {
    if (lit.direction.x() > 0.5) continue;  // a shadow that falls towards the camera counts as a part of the object
    for (const double range_m : {0.4, 0.6, 0.9}) {
      SCOPED_TRACE(describe(lit) + ", range " + std::to_string(range_m));
      testing::Scene scene;
      scene.ground_colour = {0.04, 0.50, 0.09};  // exactly the reflectance of a green object
      scene.rounds = {Round{msg::kColourGreen, {range_m + 0.085, 0.1}, 0.085, 0.15}};
      const perception::Percepts percepts = look(scene, lit);
      EXPECT_EQ(percepts.objects.blob_count, 1);
      expect_round(percepts, scene.rounds[0], 0.15);
    }
  }
}

TEST(ColouredGround, AZoneAroundTheRobotIsNoGround) {
  for (const RenderedLight& lit : kLit) {
    testing::Scene scene;
    scene.rounds = {Round{msg::kColourGreen, {0.2, 0.0}, 0.5}};
    const perception::Percepts percepts = look(scene, lit);
    EXPECT_FALSE(percepts.ground.coloured());
    ASSERT_EQ(percepts.objects.blob_count, 1);
    EXPECT_EQ(percepts.objects.blobs[0].kind, msg::kBlobZone);
  }
}

TEST(ColouredGround, AnObjectThatFillsTheViewIsNoGround) {
  testing::Scene scene;
  scene.rounds = {Round{msg::kColourRed, {0.32, 0.0}, 0.2, 0.3}};
  const perception::Percepts percepts = look(scene, kLit[0]);
  EXPECT_FALSE(percepts.ground.coloured());
  EXPECT_NE(find(percepts, msg::kColourRed, msg::kBlobObject), nullptr);
}

TEST(ColouredGround, WhatManyImagesHaveShownOutlastsAFewOthers) {
  const GroundColour green{msg::kColourGreen, {0.27, 0.27}, 1}, plain{msg::kColourUnknown, {}, 1};
  GroundColour known;
  known.learn({});
  EXPECT_EQ(known.images, 0);
  known.learn(green);
  EXPECT_EQ(known.colour, msg::kColourGreen) << "the first image decides";
  for (int i = 0; i < 20; ++i) known.learn(green);
  for (int i = 0; i < 20; ++i) known.learn(plain);
  EXPECT_EQ(known.colour, msg::kColourGreen);
  for (int i = 0; i < 5; ++i) known.learn(plain);
  EXPECT_EQ(known.colour, msg::kColourUnknown);
}

}  // namespace
}  // namespace constrictor
