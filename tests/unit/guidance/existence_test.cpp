// Landmarks that images should show and do not: log odds against Bayes' rule, and what counts as "should show".
#include "guidance/existence.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mapping.hpp"

namespace constrictor {
namespace {

using namespace guidance;
using testing::Mapping;

msg::Blob red(double x, double y) { return Mapping::blob(msg::kColourRed, msg::kBlobObject, x, y, 0.08); }
msg::Blob green(double x, double y) { return Mapping::blob(msg::kColourGreen, msg::kBlobObject, x, y, 0.08); }

TEST(Existence, FollowsBayesRule) {
  ExistenceConfig config;
  config.detection_probability = 0.8;
  config.false_alarm_probability = 0.3;
  double p = 0.5, log_odds = 0.0;
  for (const bool seen : {true, true, false, true, false, false, false}) {
    // P(exists | image) = P(image | exists) P(exists) / P(image)
    const double if_there = seen ? 0.8 : 0.2, if_not = seen ? 0.3 : 0.7;
    p = if_there * p / (if_there * p + if_not * (1.0 - p));
    log_odds = updated_log_odds(config, log_odds, seen, 1.0);
    EXPECT_NEAR(probability_of(log_odds), p, 1e-12);
  }
  // Two images of half a look each say as much as one look.
  const double halves = updated_log_odds(config, updated_log_odds(config, 0.3, false, 0.5), false, 0.5);
  EXPECT_NEAR(halves, updated_log_odds(config, 0.3, false, 1.0), 1e-12);
}

TEST(Existence, IsNeverSurerThanTheBound) {
  ExistenceConfig config;
  double log_odds = 0.0;
  for (int i = 0; i < 1000; ++i) log_odds = updated_log_odds(config, log_odds, true, 1.0);
  EXPECT_NEAR(probability_of(log_odds), config.most, 1e-12);
}

TEST(Existence, ALandmarkLeavesTheMapAfterTheComputedNumberOfMisses) {
  Mapping m;
  m.look({red(1.0, 0.2)}, 50);
  ASSERT_EQ(m.map().object_count, 1);
  const ExistenceConfig& config = m.config.existence;
  const auto odds = [](double p) { return std::log(p / (1.0 - p)); };
  const double looks_an_image = 5 * 0.02 / config.look_s;
  const double each =
      looks_an_image * std::log((1.0 - config.detection_probability) / (1.0 - config.false_alarm_probability));
  const int needed = static_cast<int>(std::ceil((odds(config.drop) - odds(config.most)) / each));
  ASSERT_GT(needed, 5) << "a few missed images are no loss";
  m.look({}, needed - 1);
  EXPECT_EQ(m.map().object_count, 1);
  m.look({}, 1);
  EXPECT_EQ(m.map().object_count, 0);
  m.look({red(1.0, 0.2)}, 5);
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_EQ(m.map().objects[0].handle, 2) << "a handle is never used again";
}

TEST(Existence, ADetectionNowAndThenKeepsTheLandmark) {
  Mapping m;
  m.look({red(1.0, 0.2)}, 20);
  for (int i = 0; i < 200; ++i) {
    m.look({}, 2);
    m.look({red(1.0, 0.2)}, 3);
  }
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_EQ(m.map().objects[0].handle, 1);
}

TEST(Existence, AZoneIsGivenUpLikeAnObject) {
  Mapping m;
  m.look({Mapping::blob(msg::kColourRed, msg::kBlobZone, 1.2, 0.0, 0.3)}, 20);
  ASSERT_EQ(m.map().object_count, 1);
  m.look({}, 100);
  EXPECT_EQ(m.map().object_count, 0);
}

/// What keeps a landmark at `landmark` from being seen; after 200 images without it, it is still believed.
struct Hidden {
  const char* name;
  Eigen::Vector2d landmark;
  std::vector<msg::Blob> also = {};    ///< blobs of the images that do not show it
  std::vector<msg::Blob> before = {};  ///< blobs of the images that showed it
  bool body = false, tilted = false;   ///< the tail lies in front of it; the head is tilted
};

class HiddenLandmark : public ::testing::TestWithParam<Hidden> {};

TEST_P(HiddenLandmark, IsStillBelieved) {
  const Hidden& hidden = GetParam();
  Mapping m;
  std::vector<msg::Blob> first = hidden.before;
  first.push_back(red(hidden.landmark.x(), hidden.landmark.y()));
  m.look(first, 20);
  if (hidden.body) {
    for (const std::size_t i : {2u, 4u, 6u, 8u})
      m.q[i] = std::numbers::pi / 4.0;  // the tail lies to the left of the head, and ahead
  }
  m.level = !hidden.tilted;
  m.look(hidden.also, 200);
  const msg::FieldMap map = m.map();
  const auto end = map.objects + map.object_count;
  EXPECT_TRUE(std::any_of(map.objects, end, [](const msg::MapObject& object) {
    return object.colour == msg::kColourRed && object.kind == msg::kBlobObject;
  }));
}

auto blob_without_range(msg::Blob blob) {
  blob.range_m = blob.width_m = std::nan("");
  return blob;
}

INSTANTIATE_TEST_SUITE_P(
    Cases, HiddenLandmark,
    ::testing::Values(
        Hidden{"BehindTheHead", {-1.0, 0.2}}, Hidden{"AtTheBorderOfTheImage", {0.8, 0.72}}, Hidden{"Far", {2.2, 0.0}},
        Hidden{"UnderTheCamera", {0.3, 0.0}}, Hidden{"ByAnotherObject", {1.4, 0.0}, {green(0.7, 0.05)}},
        Hidden{"ByAnObjectOfTheMap", {1.4, 0.0}, {}, {green(0.25, 0.0)}},
        Hidden{"ByACloseThingWithoutRange", {1.0, 0.0}, {blob_without_range(green(0.4, 0.1))}},
        Hidden{"ByAZoneOfItsColour", {1.2, 0.0}, {Mapping::blob(msg::kColourRed, msg::kBlobZone, 1.5, 0.0, 0.3)}},
        Hidden{"ByTheTilt", {1.0, 0.0}, {}, {}, false, true}, Hidden{"ByTheBody", {1.3, 0.4}, {}, {}, true}),
    [](const auto& instance) { return instance.param.name; });

TEST(Existence, WhatDoesNotHideALandmarkDoesNotSaveIt) {
  const std::vector<std::vector<msg::Blob>> scenes = {
      {green(1.45, 0.0)},                                                  // another object behind it
      {green(0.7, 0.5)},                                                   // another object beside it
      {Mapping::blob(msg::kColourGreen, msg::kBlobZone, 0.7, 0.0, 0.2)}};  // a zone before it, flat on the ground
  for (const auto& scene : scenes) {
    Mapping m;
    m.look({red(1.0, 0.0)}, 20);
    m.look(scene, 100);
    for (int i = 0; i < m.map().object_count; ++i) EXPECT_NE(m.map().objects[i].colour, msg::kColourRed);
  }
}

TEST(Existence, ADoubtfulLandmarkDoesNotCorrectThePose) {
  for (const bool doubtful : {false, true}) {
    Mapping m;
    m.look({red(1.0, 0.0)}, 40);
    m.filter.predict({0.0, 0.0}, 0.0, Eigen::Vector3d(0.01, 0.01, 1e-4).asDiagonal());
    if (doubtful) m.look({}, 13);  // less likely than `trust`, but not yet given up
    ASSERT_EQ(m.map().object_count, 1);
    // A person has moved it by 0.1 m, which the uncertainty of the pose could explain, too.
    m.look({red(1.0, 0.1)}, 1);
    const double moved_m = std::abs(m.filter.pose().p.y()) + std::abs(m.filter.pose().yaw_rad);
    if (doubtful) {
      EXPECT_LT(moved_m, 1e-9);
      EXPECT_NEAR(m.map().objects[0].y_m, 0.1, 1e-6);
      EXPECT_EQ(m.map().objects[0].handle, 1);
    } else {
      EXPECT_GT(moved_m, 0.01);
    }
  }
}

TEST(Existence, ACarriedObjectIsNotDoubted) {
  Mapping m;
  for (const std::size_t i : {10u, 12u, 14u}) m.q[i] = std::numbers::pi / 3.0;
  const Eigen::Vector2d object = m.chain()[13].p + 0.115 * left(m.chain()[13].yaw_rad);
  m.look({green(object.x(), object.y())}, 5);
  msg::TaskStatus task{};
  task.carrying = true;
  m.mapper.carry(task, m.chain(), m.tick);
  m.look({}, 200);
  ASSERT_EQ(m.map().object_count, 1);
  EXPECT_TRUE(m.map().objects[0].carried);
}

}  // namespace
}  // namespace constrictor
