// Objects lower and higher than the camera, and zones of any radius, in the scenes of an independent ray caster.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "lit_scene.hpp"

namespace constrictor {
namespace {

using perception::ObjectSizes;
using perception::Percepts;
using testing::Conditions;
using testing::kDegree;
using testing::Round;
using testing::Scene;

/// The camera is 0.085 m above the ground.
const Conditions kAttitudes[] = {
    {1.0, 0.35, 0.0, false, {}},
    {0.5, 0.35, 0.03, false, {0.0, 0.02, 0.4, 0.035}},
    {1.5, 0.3, 0.05, false, {0.03, -0.02, -2.0, 0.035}},
    {0.7, 0.4, 0.03, false, {-0.04, 0.04, 1.0, 0.035}},
};

const msg::Blob* find(const Percepts& percepts, std::uint8_t kind) {
  for (int i = 0; i < percepts.objects.blob_count; ++i) {
    if (percepts.objects.blobs[i].kind == kind) return &percepts.objects.blobs[i];
  }
  return nullptr;
}

std::string describe(const Conditions& c, double radius_m, double height_m, double range_m) {
  return "intensity " + std::to_string(c.intensity) + ", radius " + std::to_string(radius_m) + ", height " +
         std::to_string(height_m) + ", range " + std::to_string(range_m);
}

TEST(ObjectSize, ObjectsOfAnyHeightAreFoundAndMeasured) {
  for (const Conditions& c : kAttitudes) {
    for (const double height : {0.05, 0.07, 0.085, 0.1, 0.15, 0.4}) {
      for (const double radius : {0.04, 0.085, 0.16}) {
        for (const double range : {0.3, 0.6, 1.2}) {
          SCOPED_TRACE(describe(c, radius, height, range));
          Scene scene;
          scene.rounds = {Round{msg::kColourRed, {range + radius, 0.05}, radius, height}};
          const Percepts percepts = look(scene, c);
          const double seen_range = scene.rounds[0].centre.norm() - radius;
          EXPECT_EQ(percepts.objects.blob_count, 1);
          const msg::Blob* blob = find(percepts, msg::kBlobObject);
          ASSERT_NE(blob, nullptr);
          EXPECT_NEAR(blob->bearing_rad, std::atan2(0.05, range + radius), 1.5 * kDegree);
          EXPECT_NEAR(blob->range_m, seen_range, 0.06 * seen_range);
          EXPECT_NEAR(blob->width_m, 2.0 * radius, 0.03);
          const perception::ObjectSize& size = percepts.measured[msg::kColourRed];
          if (blob->cut_top) {  // the upper edge is out of view: a lower bound, and no size follows
            EXPECT_GT(blob->height_m, 0.1);
            EXPECT_LT(blob->height_m, height + 0.02 * range);
            EXPECT_EQ(size.images, 0);
            continue;
          }
          EXPECT_NEAR(blob->height_m, height, 0.01 + 0.02 * range);
          ASSERT_EQ(size.images, 1);
          EXPECT_NEAR(size.radius_m, radius, 0.015);
          EXPECT_NEAR(size.height_m, height, 0.01 + 0.02 * range);
        }
      }
    }
  }
}

TEST(ObjectSize, ZonesOfAnyRadiusAreZones) {
  for (const Conditions& c : kAttitudes) {
    for (const double radius : {0.1, 0.15, 0.25, 0.4}) {
      for (const double range : {0.3, 0.8, 1.5}) {
        SCOPED_TRACE(describe(c, radius, 0.0, range));
        Scene scene;
        scene.rounds = {Round{msg::kColourRed, {range + radius, -0.05}, radius}};
        const Percepts percepts = look(scene, c);
        EXPECT_EQ(percepts.objects.blob_count, 1);
        const msg::Blob* zone = find(percepts, msg::kBlobZone);
        ASSERT_NE(zone, nullptr);
        EXPECT_TRUE(std::isnan(zone->height_m));
        EXPECT_EQ(percepts.measured[msg::kColourRed].images, 0);
      }
    }
  }
}

TEST(ObjectSize, TheProbabilityOfAnObjectRisesWithItsHeight) {
  for (const Conditions& c : kAttitudes) {
    double before = 0.0;
    for (const double height : {0.0, 0.01, 0.03, 0.06, 0.12}) {
      SCOPED_TRACE(describe(c, 0.08, height, 0.6));
      Scene scene;
      scene.rounds = {Round{msg::kColourRed, {0.68, 0.0}, 0.08, height}};
      const Percepts percepts = look(scene, c);
      ASSERT_EQ(percepts.objects.blob_count, 1);
      const msg::Blob& blob = percepts.objects.blobs[0];
      EXPECT_GE(blob.object_probability, before);
      EXPECT_EQ(blob.kind == msg::kBlobObject, blob.object_probability >= 0.5);
      EXPECT_TRUE(height > 0.0 || blob.object_probability < 0.05);
      EXPECT_TRUE(height < 0.06 || blob.object_probability > 0.99);
      before = blob.object_probability;
    }
  }
}

TEST(ObjectSize, WhatTheBorderCutsIsNeverMistaken) {
  for (const Conditions& c : kAttitudes) {
    for (const double bearing : {-0.85, -0.75, -0.65, 0.65, 0.75, 0.85}) {
      const Eigen::Vector2d sight(std::cos(bearing), std::sin(bearing));
      for (const double range : {0.3, 0.6}) {
        Scene low, zone;
        low.rounds = {Round{msg::kColourRed, (range + 0.085) * sight, 0.085, 0.06}};
        zone.rounds = {Round{msg::kColourRed, (range + 0.3) * sight, 0.3}};
        SCOPED_TRACE(describe(c, bearing, 0.0, range));
        EXPECT_EQ(find(look(low, c), msg::kBlobZone), nullptr);
        EXPECT_EQ(find(look(zone, c), msg::kBlobObject), nullptr);
      }
    }
  }
}

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

TEST(ObjectSize, TheKnownSizeGivesTheRangeOnAZoneOfTheObjectsColour) {
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
TEST(ObjectSize, OnAZoneTheFittingOneOfSeveralKnownSizesGivesTheRange) {
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
TEST(ObjectSize, AnObjectOnAZoneStandsWithinIt) {
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

TEST(ObjectSize, OneSizeIsLearntForEachObjectOfAColour) {
  perception::SizesOfColour sizes;
  const auto learn_some = [&](double radius, double height, int images) {
    for (int i = 0; i < images; ++i) sizes.learn({radius + 0.004 * (i % 3 - 1), height, 1});
  };
  learn_some(0.08, 0.15, 20);
  learn_some(0.05, 0.2, 9);
  EXPECT_NEAR(sizes.sizes[0].radius_m, 0.05, 0.002);
  EXPECT_NEAR(sizes.sizes[1].radius_m, 0.08, 0.002);
  EXPECT_EQ(sizes.sizes[1].images, 20);
  // Wrong measurements of single images do not drive the sizes out.
  for (int i = 0; i < 4; ++i) learn_some(0.02 + 0.03 * i, 0.4, 1);
  EXPECT_EQ(std::count_if(sizes.sizes.begin(), sizes.sizes.end(), [](const auto& size) { return size.known(); }), 2);
  learn_some(0.08, 0.15, 1);
  EXPECT_EQ(sizes.sizes[0].images, 21) << "the size that was measured last comes first";
  // A further object takes the place of the one that was seen longest ago.
  learn_some(0.12, 0.1, 3);
  learn_some(0.03, 0.3, 3);
  EXPECT_NEAR(sizes.sizes[2].radius_m, 0.08, 0.002);
}

// The near rim of the zone slopes in the image, so that it is lowest where the border cuts the object.
TEST(ObjectSize, AnObjectOnAZoneIsNoNearerWhenTheBorderCutsBoth) {
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

TEST(ObjectSize, ALowObjectOfKnownSizeIsFoundOnAZoneOfItsColour) {
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
TEST(ObjectSize, AnObjectOfKnownSizeBehindAZoneOfItsColourIsNotTakenForNearer) {
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
TEST(ObjectSize, AnObjectWhoseFootIsHiddenHasNoRangeUntilItsHeightIsKnown) {
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

TEST(ObjectSize, TheStatedSizeCountsUntilImagesHaveShownAnother) {
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
