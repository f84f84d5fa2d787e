// Glare on smooth ground, in images of the simulator's renderer: a line leads towards the light, which is reflected on
// it.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "lit_scene.hpp"
#include "rendered_scene.hpp"

namespace constrictor {
namespace {

using testing::Arc;
using testing::find;
using testing::kDegree;
using testing::Round;

struct Glare {
  double elevation_rad, gloss;
};

perception::Percepts look_into(testing::Scene scene, const Glare& glare) {
  scene.ground_gloss = glare.gloss;
  return look(scene, {{std::cos(glare.elevation_rad), 0.02, std::sin(glare.elevation_rad)}, 1.0, 0.35, 0.01, {}});
}

/// Calls `check` under lights of several heights, at several strengths of the reflection.
template <class Check>
void under_glare(const Check& check) {
  for (const double elevation : {10.0, 15.0, 20.0, 35.0, 60.0}) {
    for (const double gloss : {0.3, 1.0, 2.0, 4.0}) {
      SCOPED_TRACE("light at " + std::to_string(elevation) + " degrees, gloss " + std::to_string(gloss));
      check(Glare{elevation * kDegree, gloss});
    }
  }
}

TEST(GlarePercepts, ALineTowardsTheLightIsMeasured) {
  testing::Scene scene;
  scene.line = Arc{{-0.1, 0.0}, 0.0, 0.0};
  under_glare([&](const Glare& glare) {
    const msg::LinePercept line = look_into(scene, glare).line;
    ASSERT_TRUE(line.visible);
    EXPECT_NEAR(line.offset_m, 0.0, 0.005);
    EXPECT_NEAR(line.heading_rad, 0.0, 2.5 * kDegree);
    EXPECT_LT(line.near_m, 0.2);
    EXPECT_FALSE(line.end_visible) << "at " << line.end_distance_m;
    // At twice the gloss of a polished floor the camera is saturated beyond.
    EXPECT_GT(line.far_m, glare.gloss <= 1.0 ? 1.9 : 0.2);
  });
}

TEST(GlarePercepts, ItsEndIsReportedAtItsPlaceOrNotAtAll) {
  testing::Scene scene;
  scene.line = Arc{{-0.1, 0.0}, 0.0, 0.0, 0.7};
  under_glare([&](const Glare& glare) {
    const msg::LinePercept line = look_into(scene, glare).line;
    if (glare.gloss <= 1.0) {
      EXPECT_TRUE(line.end_visible);
    }
    if (line.end_visible) {
      EXPECT_NEAR(line.end_distance_m, 0.6, 0.05);
    }
  });
}

TEST(GlarePercepts, ObjectsAndZonesAreMeasured) {
  testing::Scene scene;
  scene.rounds = {Round{msg::kColourRed, {1.0, 0.3}, 0.085, 0.15}, Round{msg::kColourGreen, {0.6, 0.0}, 0.1},
                  Round{msg::kColourYellow, {0.6, -0.3}, 0.15}};
  under_glare([&](const Glare& glare) {
    if (glare.gloss > 1.0) return;
    const perception::Percepts percepts = look_into(scene, glare);
    EXPECT_FALSE(percepts.line.visible);
    EXPECT_EQ(percepts.objects.blob_count, 3);
    for (const Round& r : scene.rounds) {
      SCOPED_TRACE("colour " + std::to_string(r.colour));
      const msg::Blob* blob = find(percepts, r.colour, r.height_m > 0.0 ? msg::kBlobObject : msg::kBlobZone);
      ASSERT_NE(blob, nullptr);
      EXPECT_NEAR(blob->bearing_rad, std::atan2(r.centre.y(), r.centre.x()), 1.5 * kDegree);
      EXPECT_NEAR(blob->range_m, r.centre.norm() - r.radius_m, 0.06 * r.centre.norm());
      EXPECT_NEAR(blob->width_m, 2.0 * r.radius_m, 0.03);
    }
  });
}

TEST(GlarePercepts, AZoneThatGlareHidesInPartIsCut) {
  int cut = 0;
  under_glare([&](const Glare& glare) {
    for (const double y : {0.1, 0.2, 0.3}) {
      testing::Scene scene;
      scene.rounds = {Round{msg::kColourGreen, {0.9, y}, 0.4}};
      const perception::Percepts percepts = look_into(scene, glare);
      for (int i = 0; i < percepts.objects.blob_count; ++i) {
        const msg::Blob& blob = percepts.objects.blobs[i];
        SCOPED_TRACE("zone at " + std::to_string(y) + ", blob " + std::to_string(i));
        if (glare.gloss <= 2.0) {
          EXPECT_NE(blob.kind, msg::kBlobObject);
        }
        cut += blob.cut_left || blob.cut_right ? 1 : 0;
        if (blob.cut_left || blob.cut_right || blob.kind != msg::kBlobZone || std::isnan(blob.range_m)) continue;
        EXPECT_NEAR(blob.width_m, 0.8, 0.08);
        EXPECT_NEAR(blob.bearing_rad, std::atan2(y, 0.9), 3.0 * kDegree);
      }
    }
  });
  EXPECT_GT(cut, 0);
}

TEST(GlarePercepts, BareGroundIsNoPercept) {
  under_glare([](const Glare& glare) {
    const perception::Percepts percepts = look_into({}, glare);
    EXPECT_FALSE(percepts.line.visible);
    EXPECT_EQ(percepts.objects.blob_count, 0);
    EXPECT_EQ(percepts.objects.obstacle_count, 0);
  });
}

// The bright pixels of a noisy image were taken for glare, and those beside them for pale colours: with the noise 0.2,
// missions took three times as long.
TEST(GlarePercepts, NoiseIsNoGlare) {
  for (const double noise_sd : {0.1, 0.2, 0.3}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      SCOPED_TRACE("noise " + std::to_string(noise_sd) + ", seed " + std::to_string(seed));
      testing::Scene scene;
      scene.seed = seed;
      scene.line = Arc{{-0.1, 0.0}, 0.0, 0.0};
      scene.rounds = {Round{msg::kColourGreen, {0.9, 0.4}, 0.085, 0.15}};
      const perception::Percepts percepts = look(scene, {{0.4, 0.3, 0.85}, 1.0, 0.45, noise_sd, {}});
      EXPECT_TRUE(percepts.line.visible);
      EXPECT_EQ(percepts.objects.blob_count, 1);
      EXPECT_NE(find(percepts, msg::kColourGreen, msg::kBlobObject), nullptr);
    }
  }
}

}  // namespace
}  // namespace constrictor
