// Objects whose foot an image does not show: on a zone of their colour, or behind something. Known sizes give their
// range. The scenes are those of an independent ray caster.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "sized_objects.hpp"

namespace constrictor {
namespace {

using perception::ObjectSizes;
using perception::Percepts;
using testing::Conditions;
using testing::describe;
using testing::find;
using testing::kAttitudes;
using testing::kDegree;
using testing::Round;
using testing::Scene;

void learn(ObjectSizes& sizes, double radius_m, double height_m) {
  perception::MeasuredSizes one;
  one[msg::kColourGreen] = {radius_m, height_m, 1};
  for (int i = 0; i < perception::ObjectSize::kEnoughImages; ++i) sizes.learn(one);
}

ObjectSizes known(double radius_m, double height_m) {
  ObjectSizes sizes;
  learn(sizes, radius_m, height_m);
  return sizes;
}

TEST(KnownSize, TheKnownSizeGivesTheRangeOnAZoneOfTheObjectsColour) {
  for (const Conditions& c : kAttitudes) {
    for (const double height : {0.1, 0.15, 0.3}) {
      for (const double distance : {0.6, 0.9}) {
        SCOPED_TRACE(describe(c, 0.085, height, distance));
        Scene scene;
        scene.rounds = {Round{msg::kColourGreen, {distance, 0.0}, 0.3},
                        Round{msg::kColourGreen, {distance, 0.0}, 0.085, height}};
        const Percepts percepts = look(scene, c, 1, known(0.085, height));
        const msg::Blob* object = find(percepts, msg::kBlobObject);
        ASSERT_NE(object, nullptr);
        ASSERT_NE(find(percepts, msg::kBlobZone), nullptr);
        EXPECT_NEAR(object->range_m, distance - 0.085, 0.07 * distance);
        EXPECT_EQ(percepts.measured[msg::kColourGreen].images, 0);
      }
    }
  }
}

// Two objects of one colour have different sizes. A mean of both would be 0.4 m too far for one of them.
TEST(KnownSize, OnAZoneTheFittingOneOfSeveralKnownSizesGivesTheRange) {
  const std::array<std::array<double, 2>, 3> known_sizes{{{0.11, 0.12}, {0.05, 0.2}, {0.09, 0.2}}};
  for (const Conditions& c : kAttitudes) {
    for (const std::size_t last : {0U, 1U, 2U}) {
      ObjectSizes sizes;
      for (std::size_t i = 1; i <= known_sizes.size(); ++i) {
        const auto& [radius, height] = known_sizes[(last + i) % known_sizes.size()];
        learn(sizes, radius, height);
      }
      for (const auto& [radius, height] : known_sizes) {
        for (const double distance : {0.6, 0.9, 1.2}) {
          SCOPED_TRACE(describe(c, radius, height, distance));
          Scene scene;
          scene.rounds = {Round{msg::kColourGreen, {distance, 0.0}, 0.35},
                          Round{msg::kColourGreen, {distance, 0.0}, radius, height}};
          const Percepts percepts = look(scene, c, 1, sizes);
          const msg::Blob* object = find(percepts, msg::kBlobObject);
          ASSERT_NE(object, nullptr);
          EXPECT_NEAR(object->range_m, distance - radius, 0.1 * distance) << "size " << last << " was measured last";
        }
      }
    }
  }
}

// By width and height alone, a small object looks like a larger one that is farther away.
TEST(KnownSize, AnObjectOnAZoneStandsWithinIt) {
  for (const Conditions& c : kAttitudes) {
    for (const bool small_last : {false, true}) {
      ObjectSizes sizes;
      learn(sizes, small_last ? 0.1 : 0.05, small_last ? 0.31 : 0.2);
      learn(sizes, small_last ? 0.05 : 0.1, small_last ? 0.2 : 0.31);
      for (const double radius : {0.05, 0.1}) {
        SCOPED_TRACE(describe(c, radius, small_last ? 0.2 : 0.31, 0.9));
        Scene scene;
        scene.rounds = {Round{msg::kColourGreen, {0.9, 0.0}, 0.3},
                        Round{msg::kColourGreen, {0.9, 0.0}, radius, radius < 0.07 ? 0.2 : 0.31}};
        const Percepts percepts = look(scene, c, 1, sizes);
        const msg::Blob* object = find(percepts, msg::kBlobObject);
        ASSERT_NE(object, nullptr);
        EXPECT_NEAR(object->range_m, 0.9 - radius, 0.1)
            << (small_last ? "the small one" : "the large one") << " is last";
      }
    }
  }
}

TEST(KnownSize, OneSizeIsLearntForEachObjectOfAColour) {
  perception::SizesOfColour sizes;
  const auto learn_some = [&](double radius, double height, int images) {
    for (int i = 0; i < images; ++i) sizes.learn({radius + 0.004 * (i % 3 - 1), height, 1});
  };
  learn_some(0.08, 0.15, 20);
  EXPECT_EQ(sizes.candidates().size(), 1U);
  // What a few images show of an object that something hides in part is not another object, but changes the mean.
  learn_some(0.05, 0.15, 6);
  ASSERT_EQ(sizes.candidates().size(), 1U);
  EXPECT_NEAR(sizes.candidates()[0].radius_m, (20 * 0.08 + 6 * 0.05) / 26, 0.002);
  learn_some(0.05, 0.2, 9);
  ASSERT_EQ(sizes.candidates().size(), 2U);
  EXPECT_NEAR(sizes.candidates()[0].radius_m, 0.05, 0.002);
  EXPECT_NEAR(sizes.candidates()[1].radius_m, 0.08, 0.002);
  // Wrong measurements of single images do not drive the sizes out.
  for (int i = 0; i < 4; ++i) learn_some(0.02 + 0.03 * i, 0.4, 1);
  learn_some(0.08, 0.15, 1);
  ASSERT_EQ(sizes.candidates().size(), 2U);
  EXPECT_EQ(sizes.candidates()[0].images, 21) << "the size that was measured last comes first";
}

// The near rim of the zone slopes in the image, so that it is lowest where the border cuts the object.
TEST(KnownSize, AnObjectOnAZoneIsNoNearerWhenTheBorderCutsBoth) {
  int cut = 0;
  for (const Conditions& c : kAttitudes) {
    for (const double side : {-1.0, 1.0}) {
      for (const double bearing : {0.66, 0.7, 0.74, 0.78, 0.82}) {
        SCOPED_TRACE(describe(c, 0.085, 0.15, side * bearing));
        const Eigen::Vector2d centre = 0.93 * Eigen::Vector2d(std::cos(bearing), side * std::sin(bearing));
        Scene scene;
        scene.rounds = {Round{msg::kColourGreen, centre - Eigen::Vector2d(0.15, 0.0), 0.4},
                        Round{msg::kColourGreen, centre, 0.085, 0.15}};
        const Percepts percepts = look(scene, c, 1, known(0.085, 0.15));
        const msg::Blob* object = find(percepts, msg::kBlobObject);
        if (object == nullptr || !std::isfinite(object->range_m)) continue;
        EXPECT_NEAR(object->range_m, 0.93 - 0.085, 0.1);
        cut += object->cut_left || object->cut_right ? 1 : 0;
      }
    }
  }
  EXPECT_GT(cut, 10);
}

TEST(KnownSize, ALowObjectOfKnownSizeIsFoundOnAZoneOfItsColour) {
  for (const Conditions& c : kAttitudes) {
    for (const double distance : {0.6, 0.9}) {
      SCOPED_TRACE(describe(c, 0.085, 0.06, distance));
      Scene scene;
      scene.rounds = {Round{msg::kColourGreen, {distance, 0.05}, 0.3}};
      EXPECT_EQ(find(look(scene, c, 1, known(0.085, 0.06)), msg::kBlobObject), nullptr);
      scene.rounds.push_back(Round{msg::kColourGreen, {distance, 0.05}, 0.085, 0.06});
      EXPECT_EQ(find(look(scene, c), msg::kBlobObject), nullptr);  // of unknown size
      const Percepts percepts = look(scene, c, 1, known(0.085, 0.06));
      const msg::Blob* object = find(percepts, msg::kBlobObject);
      ASSERT_NE(object, nullptr);
      ASSERT_NE(find(percepts, msg::kBlobZone), nullptr);
      EXPECT_NEAR(object->range_m, scene.rounds[1].centre.norm() - 0.085, 0.05);
    }
  }
}

// From afar the zone is a pixel or two high, and the region of both looks like an object that stands on its near edge.
TEST(KnownSize, AnObjectOfKnownSizeBehindAZoneOfItsColourIsNotTakenForNearer) {
  const double radius_m = 0.08, height_m = 0.15, zone_radius_m = 0.25;
  for (const Conditions& c : kAttitudes) {
    for (const double distance_m : {2.2, 2.5, 2.8}) {
      SCOPED_TRACE(describe(c, radius_m, height_m, distance_m));
      Scene scene;
      scene.rounds = {Round{msg::kColourGreen, {distance_m - 0.25, 0.05}, zone_radius_m},
                      Round{msg::kColourGreen, {distance_m, 0.0}, radius_m, height_m}};
      const Percepts percepts = look(scene, c, 1, known(radius_m, height_m));
      const msg::Blob* object = find(percepts, msg::kBlobObject);
      ASSERT_NE(object, nullptr);
      EXPECT_NEAR(object->range_m, distance_m - radius_m, 0.12 * distance_m);  // its near edge is 0.4 m nearer
      // A smaller object than the known one is measured where it stands as soon as it is near.
      scene.rounds = {Round{msg::kColourGreen, {1.2, 0.0}, 0.5 * radius_m, height_m}};
      const Percepts near = look(scene, c, 1, known(radius_m, height_m));
      const msg::Blob* small = find(near, msg::kBlobObject);
      ASSERT_NE(small, nullptr);
      EXPECT_NEAR(small->range_m, 1.2 - 0.5 * radius_m, 0.08);
    }
  }
}

// A wall hides the foot of a distant object. Its upper edge gives the range only if its height is known.
TEST(KnownSize, AnObjectWhoseFootIsHiddenHasNoRangeUntilItsHeightIsKnown) {
  for (const Conditions& c : kAttitudes) {
    Scene scene;
    scene.rounds = {Round{msg::kColourUnknown, {1.5, 0.0}, 0.3, 0.09},
                    Round{msg::kColourGreen, {2.4, 0.0}, 0.085, 0.25}};
    const Percepts unknown_height = look(scene, c);
    const msg::Blob* object = find(unknown_height, msg::kBlobObject);
    ASSERT_NE(object, nullptr);
    EXPECT_NEAR(object->bearing_rad, 0.0, 2.0 * kDegree);
    EXPECT_TRUE(std::isnan(object->range_m)) << object->range_m;
    const Percepts known_size = look(scene, c, 1, known(0.085, 0.25));
    const msg::Blob* same = find(known_size, msg::kBlobObject);
    ASSERT_NE(same, nullptr);
    EXPECT_NEAR(same->range_m, 2.4 - 0.085, 0.4);
  }
}

TEST(KnownSize, TheStatedSizeCountsUntilImagesHaveShownAnother) {
  perception::PerceptionConfig config;
  PriorKnowledge stated;
  stated.object_radius_m = 0.085;
  stated.object_height_m = 0.06;
  config.know(stated);
  perception::LineAndBlobDetector detector(config);
  const msg::CameraInfo info = testing::camera_info();
  const testing::Head head;
  const perception::GroundCamera camera(info, testing::orientation(head), head.height_m);
  const auto object_in = [&](const Scene& scene, const ObjectSizes& seen) {
    const Percepts percepts = detector.detect(testing::draw(scene, info, head), camera, msg::kColourBlue, seen);
    const msg::Blob* object = find(percepts, msg::kBlobObject);
    return object ? std::optional(*object) : std::nullopt;
  };

  Scene low;  // on a zone of its colour, where no image shows the size
  low.rounds = {Round{msg::kColourGreen, {0.7, 0.05}, 0.3}, Round{msg::kColourGreen, {0.7, 0.05}, 0.085, 0.06}};
  const auto found = object_in(low, {});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->range_m, low.rounds[1].centre.norm() - 0.085, 0.05);

  Scene tall;
  tall.rounds = {Round{msg::kColourGreen, {0.7, 0.0}, 0.3}, Round{msg::kColourGreen, {0.7, 0.0}, 0.06, 0.3}};
  const auto misjudged = object_in(tall, {}), judged = object_in(tall, known(0.06, 0.3));
  ASSERT_TRUE(misjudged && judged);
  EXPECT_NEAR(judged->range_m, 0.7 - 0.06, 0.05);
  EXPECT_NEAR(misjudged->range_m, 0.085 * (0.7 / 0.06 - 1.0), 0.1) << "by its width, as if it were larger";
}

}  // namespace
}  // namespace constrictor
