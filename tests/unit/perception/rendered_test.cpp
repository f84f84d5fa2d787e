// Percepts compared with the simulator's scenes: light, shadow, texture, noise, and the shadow of the body.
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
using testing::RenderedLight;
using testing::Round;

const RenderedLight kLights[] = {
    {{0.3, -0.4, 0.85}, 1.0, 0.35, 0.0, {}},
    {{-0.6, 0.5, 0.5}, 0.5, 0.3, 0.03, {0.02, -0.02, 0.7, 0.035}},
    {{0.1, 0.1, 1.0}, 1.5, 0.35, 0.05, {-0.03, 0.02, 0.0, 0.035}},
    {{0.8, 0.2, 0.4}, 0.7, 0.25, 0.05, {0.0, 0.04, 2.0, 0.035}},
};

TEST(Rendered, LineMatchesItsArc) {
  for (const RenderedLight& light : kLights) {
    for (const Arc& arc : {Arc{{-0.2, 0.1}, -0.15, 0.7}, Arc{{-0.1, -0.1}, 0.35, -1.0}}) {
      SCOPED_TRACE(describe(light) + ", curvature " + std::to_string(arc.curvature_1_m));
      testing::Scene scene;
      scene.line = arc;
      const perception::Percepts percepts = look(scene, light);
      ASSERT_TRUE(percepts.line.visible);
      const auto s = arc.length_at_x(percepts.line.lookahead_m);
      ASSERT_TRUE(s);
      EXPECT_NEAR(percepts.line.lookahead_m, 0.35, 0.01);
      EXPECT_NEAR(percepts.line.offset_m, arc.at(*s).y(), 0.01);
      EXPECT_NEAR(percepts.line.heading_rad, arc.heading_at(*s), 2.5 * kDegree);
      EXPECT_NEAR(percepts.line.curvature_1_m, arc.curvature_1_m, 0.15);
      EXPECT_FALSE(percepts.line.end_visible);
      EXPECT_EQ(percepts.objects.blob_count, 0);
    }
  }
}

TEST(Rendered, EndOfTheLineIsReportedAtItsPlace) {
  for (const RenderedLight& light : kLights) {
    SCOPED_TRACE(describe(light));
    testing::Scene scene;
    scene.line = Arc{{-0.1, 0.0}, 0.05, -0.2, 0.85};
    const msg::LinePercept line = look(scene, light).line;
    ASSERT_TRUE(line.visible);
    EXPECT_TRUE(line.end_visible);
    EXPECT_NEAR(line.end_distance_m, scene.line->at(0.85).x(), 0.06);
  }
}

TEST(Rendered, ObjectsAndZonesAreFoundAndDistinguished) {
  for (const RenderedLight& light : kLights) {
    SCOPED_TRACE(describe(light));
    testing::Scene scene;
    scene.line = Arc{{-0.1, 0.0}, 0.0, 0.3};
    scene.rounds = {Round{msg::kColourGreen, {1.0, 0.5}, 0.09, 0.15}, Round{msg::kColourRed, {1.1, -0.35}, 0.08, 0.15},
                    Round{msg::kColourGreen, {0.7, -0.5}, 0.15}, Round{msg::kColourYellow, {0.55, 0.3}, 0.1}};
    const perception::Percepts percepts = look(scene, light);
    EXPECT_TRUE(percepts.line.visible);
    EXPECT_EQ(percepts.objects.blob_count, 4);
    for (const Round& r : scene.rounds) {
      SCOPED_TRACE("colour " + std::to_string(r.colour) + " at range " + std::to_string(r.centre.norm()));
      const msg::Blob* blob = find(percepts, r.colour, r.height_m > 0.0 ? msg::kBlobObject : msg::kBlobZone);
      ASSERT_NE(blob, nullptr);
      if (blob->cut_left || blob->cut_right) continue;
      const double range = r.centre.norm() - r.radius_m;
      EXPECT_NEAR(blob->bearing_rad, std::atan2(r.centre.y(), r.centre.x()), 1.5 * kDegree);
      EXPECT_NEAR(blob->range_m, range, 0.06 * range);
      EXPECT_NEAR(blob->width_m, 2.0 * r.radius_m, 0.03);
    }
  }
}

// Holds for a colour that is added to the IDL: the simulator's reflectance lies within perception's hues.
TEST(Rendered, AnObjectOfEachColourIsRecognised) {
  for (std::uint8_t colour = msg::kColourUnknown + 1; colour < msg::kColourCount; ++colour) {
    const std::uint8_t line_colour = colour == msg::kColourBlue ? msg::kColourGreen : msg::kColourBlue;
    for (const RenderedLight& light : kLights) {
      SCOPED_TRACE("colour " + std::to_string(colour) + ", " + describe(light));
      testing::Scene scene;
      scene.rounds = {Round{colour, {0.9, 0.1}, 0.08, 0.15}};
      const perception::Percepts percepts = look(scene, light, line_colour);
      EXPECT_EQ(percepts.objects.blob_count, 1);
      const msg::Blob* blob = find(percepts, colour, msg::kBlobObject);
      ASSERT_NE(blob, nullptr);
      EXPECT_NEAR(blob->bearing_rad, std::atan2(0.1, 0.9), 1.5 * kDegree);
      EXPECT_NEAR(blob->width_m, 0.16, 0.03);
    }
  }
}

TEST(Rendered, RangeHoldsFromNearToFar) {
  for (const RenderedLight& light : kLights) {
    for (const double range : {0.3, 1.5}) {
      SCOPED_TRACE(describe(light) + ", range " + std::to_string(range));
      testing::Scene scene;
      scene.rounds = {Round{msg::kColourRed, {range + 0.085, 0.0}, 0.085, 0.15}};
      const perception::Percepts percepts = look(scene, light);
      EXPECT_FALSE(percepts.line.visible);
      EXPECT_EQ(percepts.objects.blob_count, 1);
      const msg::Blob* blob = find(percepts, msg::kColourRed, msg::kBlobObject);
      ASSERT_NE(blob, nullptr);
      EXPECT_NEAR(blob->bearing_rad, 0.0, 1.5 * kDegree);
      EXPECT_NEAR(blob->range_m, range, 0.06 * range);
    }
  }
}

TEST(Rendered, NothingIsSeenOnBareGround) {
  for (const RenderedLight& light : kLights) {
    const perception::Percepts percepts = look({}, light);
    EXPECT_FALSE(percepts.line.visible);
    EXPECT_EQ(percepts.objects.blob_count, 0);
  }
}

}  // namespace
}  // namespace constrictor
