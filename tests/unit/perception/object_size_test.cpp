// Objects lower and higher than the camera, and zones of any radius, in the scenes of an independent ray caster.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>

#include "sized_objects.hpp"

namespace constrictor {
namespace {

using perception::Percepts;
using testing::Conditions;
using testing::describe;
using testing::find;
using testing::kAttitudes;
using testing::kDegree;
using testing::Round;
using testing::Scene;

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

}  // namespace
}  // namespace constrictor
