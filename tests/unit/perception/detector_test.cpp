// Percepts compared with the scenes of an independent ray caster, whose geometry is known exactly.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "constrictor/colours.hpp"
#include "lit_scene.hpp"
#include "perception/colour_edge.hpp"

namespace constrictor {
namespace {

using perception::Percepts;
using testing::Arc;
using testing::Conditions;
using testing::find;
using testing::Head;
using testing::kDegree;
using testing::Round;
using testing::Scene;

const Conditions kConditions[] = {
    {1.0, 0.35, 0.0, false, {}},
    {0.5, 0.35, 0.03, false, {0.0, 0.02, 0.4, 0.035}},
    {1.5, 0.3, 0.05, false, {0.03, -0.02, -2.0, 0.035}},
    {1.0, 0.35, 0.05, true, {-0.05, 0.04, 1.0, 0.035}},
    {0.6, 0.5, 0.05, true, {0.0, -0.05, 3.0, 0.035}},
};

TEST(Line, OffsetHeadingAndCurvatureMatchTheArc) {
  const Arc arcs[] = {
      {{-0.2, 0.00}, 0.00, 0.0}, {{-0.2, 0.10}, -0.1, 0.8}, {{-0.2, -0.12}, 0.2, -0.9},
      {{0.05, -0.2}, 0.9, -0.5}, {{0.0, 0.15}, -0.3, 1.2},  {{-0.1, -0.10}, 0.45, 0.0},
  };
  for (const Conditions& c : kConditions) {
    for (const Arc& arc : arcs) {
      Scene scene;
      scene.line = arc;
      const Percepts percepts = look(scene, c);
      const msg::LinePercept& line = percepts.line;
      SCOPED_TRACE(describe(c) + ", arc heading " + std::to_string(arc.heading_rad) + ", curvature " +
                   std::to_string(arc.curvature_1_m));
      ASSERT_TRUE(line.visible);
      EXPECT_NEAR(line.lookahead_m, 0.35, 0.01);
      const auto s = arc.length_at_x(line.lookahead_m);
      ASSERT_TRUE(s);
      EXPECT_NEAR(line.offset_m, arc.at(*s).y(), 0.01);
      EXPECT_NEAR(line.heading_rad, arc.heading_at(*s), 2.5 * kDegree);
      EXPECT_NEAR(line.curvature_1_m, arc.curvature_1_m, 0.15);
      EXPECT_FALSE(line.end_visible);
      EXPECT_EQ(percepts.objects.blob_count, 0);
      ASSERT_GE(line.point_count, 8);
      for (int i = 0; i < line.point_count; ++i) {
        // distance of the reported point from the nearest point of the arc
        double nearest = 1e9;
        for (double t = 0.0; t < arc.length_m; t += 0.01) {
          nearest = std::min(nearest, (arc.at(t) - Eigen::Vector2d(line.x_m[i], line.y_m[i])).norm());
        }
        EXPECT_LT(nearest, 0.012 + 0.02 * line.x_m[i]) << "point " << i << " at x " << line.x_m[i];
      }
    }
  }
}

TEST(Line, IsSeenAlsoAcrossTheView) {
  Scene scene;
  scene.line = Arc{{0.05, -2.0}, 1.35, 0.0};
  for (const Conditions& c : kConditions) {
    SCOPED_TRACE(describe(c));
    const msg::LinePercept line = look(scene, c).line;
    ASSERT_TRUE(line.visible);
    EXPECT_NEAR(line.heading_rad, 1.35, 4.0 * kDegree);
    // distance of the reported point to the straight line
    const Eigen::Vector2d d = Eigen::Vector2d(line.lookahead_m, line.offset_m) - scene.line->start;
    EXPECT_NEAR(d.y() * std::cos(1.35) - d.x() * std::sin(1.35), 0.0, 0.015);
  }
}

TEST(Line, EndIsReportedAtItsPlace) {
  for (const Conditions& c : kConditions) {
    for (const double length : {0.45, 0.7, 1.0}) {
      SCOPED_TRACE(describe(c) + ", length " + std::to_string(length));
      Scene scene;
      scene.line = Arc{{-0.1, 0.05}, -0.05, 0.2, length};
      const msg::LinePercept line = look(scene, c).line;
      ASSERT_TRUE(line.visible);
      EXPECT_TRUE(line.end_visible);
      const double end_x = scene.line->at(length).x();
      EXPECT_NEAR(line.end_distance_m, end_x, 0.02 + 0.05 * end_x);
      EXPECT_NEAR(line.far_m, end_x, 0.02 + 0.07 * end_x);
    }
  }
}

TEST(Line, HiddenEndIsNotReported) {
  for (const Conditions& c : kConditions) {
    SCOPED_TRACE(describe(c));
    Scene scene;
    scene.line = Arc{{-0.1, 0.0}, 0.0, 0.0, 5.0};
    scene.rounds = {Round{msg::kColourRed, {0.9, 0.0}, 0.09, 0.15}};
    EXPECT_FALSE(look(scene, c).line.end_visible);
  }
}

TEST(Line, ObjectOnTheLineDoesNotBendIt) {
  for (const Conditions& c : kConditions) {
    for (const double side : {-0.06, -0.03, 0.0, 0.04, 0.07}) {
      SCOPED_TRACE(describe(c) + ", object beside the line by " + std::to_string(side));
      Scene scene;
      scene.line = Arc{{-0.1, 0.0}, 0.0, 0.0};
      scene.rounds = {Round{msg::kColourGreen, {0.62, side}, 0.08, 0.15}};
      const Percepts percepts = look(scene, c);
      ASSERT_TRUE(percepts.line.visible);
      EXPECT_NEAR(percepts.line.offset_m, 0.0, 0.01);
      EXPECT_NEAR(percepts.line.heading_rad, 0.0, 3.0 * kDegree);
      EXPECT_NEAR(percepts.line.curvature_1_m, 0.0, 0.3);
      EXPECT_NE(find(percepts, msg::kColourGreen, msg::kBlobObject), nullptr);
    }
  }
}

TEST(Blobs, BearingRangeAndWidthOfAnObject) {
  for (const Conditions& c : kConditions) {
    for (const double range : {0.25, 0.5, 0.9, 1.3, 1.5}) {
      for (const double bearing : {-0.45, 0.0, 0.3}) {
        for (const std::uint8_t colour : {msg::kColourGreen, msg::kColourRed, msg::kColourYellow, msg::kColourBlue}) {
          if (colour != msg::kColourGreen && std::abs(bearing) > 0.0) continue;
          SCOPED_TRACE(describe(c) + ", range " + std::to_string(range) + ", bearing " + std::to_string(bearing) +
                       ", colour " + std::to_string(colour));
          const double radius = 0.085;
          Scene scene;
          scene.rounds = {
              Round{colour, (range + radius) * Eigen::Vector2d(std::cos(bearing), std::sin(bearing)), radius, 0.15}};
          const Percepts percepts = look(scene, c);
          EXPECT_EQ(percepts.objects.blob_count, 1);
          EXPECT_FALSE(percepts.line.visible);
          const msg::Blob* blob = find(percepts, colour, msg::kBlobObject);
          ASSERT_NE(blob, nullptr);
          if (blob->cut_left || blob->cut_right) continue;
          EXPECT_NEAR(blob->bearing_rad, bearing, 1.5 * kDegree);
          EXPECT_NEAR(blob->range_m, range, 0.06 * range);
          EXPECT_NEAR(blob->width_m, 2.0 * radius, 0.03);
        }
      }
    }
  }
}

TEST(Blobs, ZoneIsNotAnObject) {
  for (const Conditions& c : kConditions) {
    for (const double range : {0.3, 0.8, 1.5}) {
      SCOPED_TRACE(describe(c) + ", range " + std::to_string(range));
      Scene scene;
      scene.rounds = {Round{msg::kColourRed, {range + 0.15, 0.1}, 0.15}};
      const Percepts percepts = look(scene, c);
      EXPECT_EQ(percepts.objects.blob_count, 1);
      const msg::Blob* blob = find(percepts, msg::kColourRed, msg::kBlobZone);
      ASSERT_NE(blob, nullptr);
      const double true_range = scene.rounds[0].centre.norm() - 0.15;
      EXPECT_NEAR(blob->bearing_rad, std::atan2(0.1, range + 0.15), 1.5 * kDegree);
      EXPECT_NEAR(blob->range_m, true_range, 0.06 * true_range + 0.005);
      // Far away, the left and right ends of the zone are thinner than a pixel.
      EXPECT_NEAR(blob->width_m, 0.30, range < 1.0 ? 0.05 : 0.12);
    }
  }
}

TEST(Blobs, ObjectOnAZoneOfItsColourGivesBoth) {
  for (const Conditions& c : kConditions) {
    SCOPED_TRACE(describe(c));
    Scene scene;
    scene.rounds = {Round{msg::kColourGreen, {0.8, 0.0}, 0.2}, Round{msg::kColourGreen, {0.8, 0.0}, 0.085, 0.15}};
    const Percepts percepts = look(scene, c);
    const msg::Blob* object = find(percepts, msg::kColourGreen, msg::kBlobObject);
    const msg::Blob* zone = find(percepts, msg::kColourGreen, msg::kBlobZone);
    ASSERT_NE(object, nullptr);
    ASSERT_NE(zone, nullptr);
    EXPECT_NEAR(object->range_m, 0.715, 0.06);
    EXPECT_NEAR(zone->range_m, 0.6, 0.04);
  }
}

// The foot of the object is the lower edge of what is in view of the zone behind it, and no edge of the zone.
TEST(Blobs, AZoneBehindAnObjectOfItsColourIsNoNearerThanItIs) {
  int seen = 0;
  for (const Conditions& c : kConditions) {
    for (const double behind_m : {0.6, 0.9}) {
      SCOPED_TRACE(describe(c));
      Scene scene;
      scene.rounds = {Round{msg::kColourGreen, {1.2 + behind_m, 0.0}, 0.4},
                      Round{msg::kColourGreen, {1.2, 0.0}, 0.085, 0.15}};
      const Percepts percepts = look(scene, c);
      const msg::Blob* object = find(percepts, msg::kColourGreen, msg::kBlobObject);
      ASSERT_NE(object, nullptr);
      EXPECT_NEAR(object->range_m, 1.2 - 0.085, 0.08);
      const msg::Blob* zone = find(percepts, msg::kColourGreen, msg::kBlobZone);
      if (zone == nullptr) continue;
      ++seen;
      EXPECT_NEAR(zone->bearing_rad, 0.0, 0.05);
      const double near_edge_m = 1.2 + behind_m - 0.4;
      EXPECT_TRUE(std::isnan(zone->range_m) || zone->range_m > near_edge_m - 0.1) << zone->range_m;
    }
  }
  EXPECT_GT(seen, 3);
}

TEST(Blobs, SeveralColoursAtOnceWithTheLine) {
  for (const Conditions& c : kConditions) {
    SCOPED_TRACE(describe(c));
    Scene scene;
    scene.line = Arc{{-0.1, 0.0}, 0.0, 0.3};
    scene.rounds = {Round{msg::kColourGreen, {1.0, 0.5}, 0.09, 0.15}, Round{msg::kColourRed, {1.1, -0.35}, 0.08, 0.15},
                    Round{msg::kColourGreen, {0.7, -0.5}, 0.15}, Round{msg::kColourYellow, {0.5, 0.35}, 0.1}};
    const Percepts percepts = look(scene, c);
    EXPECT_TRUE(percepts.line.visible);
    EXPECT_EQ(percepts.objects.blob_count, 4);
    EXPECT_NE(find(percepts, msg::kColourGreen, msg::kBlobObject), nullptr);
    EXPECT_NE(find(percepts, msg::kColourRed, msg::kBlobObject), nullptr);
    EXPECT_NE(find(percepts, msg::kColourGreen, msg::kBlobZone), nullptr);
    EXPECT_NE(find(percepts, msg::kColourYellow, msg::kBlobZone), nullptr);
  }
}

TEST(Blobs, NothingIsSeenInAnEmptyScene) {
  for (const Conditions& c : kConditions) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      SCOPED_TRACE(describe(c));
      const Percepts percepts = look({}, c, seed);
      EXPECT_FALSE(percepts.line.visible);
      EXPECT_FALSE(percepts.line.end_visible);
      EXPECT_TRUE(std::isnan(percepts.line.offset_m));
      EXPECT_EQ(percepts.objects.blob_count, 0);
    }
  }
}

TEST(Blobs, ObjectThatLeavesTheViewIsNeverAZone) {
  for (const double side : {-1.0, 1.0}) {
    for (const double range : {0.2, 0.6}) {
      for (double bearing = 0.5; bearing < 1.15; bearing += 0.1) {
        SCOPED_TRACE("range " + std::to_string(range) + ", bearing " + std::to_string(side * bearing));
        Scene scene;
        scene.rounds = {Round{msg::kColourRed,
                              (range + 0.085) * Eigen::Vector2d(std::cos(bearing), side * std::sin(bearing)), 0.085,
                              0.15}};
        const Percepts percepts = look(scene, kConditions[0]);
        EXPECT_LE(percepts.objects.blob_count, 1);
        EXPECT_EQ(find(percepts, msg::kColourRed, msg::kBlobZone), nullptr);
      }
    }
  }
}

TEST(Blobs, BlobCutByTheBorderIsMarked) {
  Scene scene;
  scene.rounds = {Round{msg::kColourGreen, {0.18, 0.0}, 0.085, 0.15}};
  const Percepts percepts = look(scene, kConditions[0]);
  const msg::Blob* blob = find(percepts, msg::kColourGreen, msg::kBlobObject);
  ASSERT_NE(blob, nullptr);
  EXPECT_TRUE(blob->cut_top);
  EXPECT_NEAR(blob->bearing_rad, 0.0, 1.5 * kDegree);
}

// The shipped hues decide which channels make up a colour.
TEST(ColourStrength, IsTheDifferenceOfTheChannelsThatMakeUpTheColour) {
  const cv::Mat image(2, 2, CV_8UC3, cv::Scalar(200, 140, 20));  // red, green, blue
  const auto strength = [&](std::uint8_t colour) { return perception::colour_strength(image, colour, {1.0, 1.0}); };
  EXPECT_DOUBLE_EQ(strength(msg::kColourRed), 200.0 - 0.5 * (140.0 + 20.0));
  EXPECT_DOUBLE_EQ(strength(msg::kColourGreen), 140.0 - 0.5 * (200.0 + 20.0));
  EXPECT_DOUBLE_EQ(strength(msg::kColourBlue), 20.0 - 0.5 * (200.0 + 140.0));
  EXPECT_DOUBLE_EQ(strength(msg::kColourYellow), 0.5 * (200.0 + 140.0) - 20.0);
  EXPECT_EQ(strength(msg::kColourUnknown), 0.0);
  EXPECT_EQ(strength(msg::kColourCount), 0.0);
}

TEST(ColourStrength, IsPositiveForEachColourAndZeroForGrey) {
  for (std::uint8_t colour = msg::kColourUnknown + 1; colour < msg::kColourCount; ++colour) {
    const Rgb8& seen = look_of(colour).screen;
    const cv::Mat coloured(2, 2, CV_8UC3, cv::Scalar(seen[0], seen[1], seen[2]));
    const cv::Mat grey(2, 2, CV_8UC3, cv::Scalar(130, 130, 130));
    EXPECT_GT(perception::colour_strength(coloured, colour, {1.0, 1.0}), 80.0) << int{colour};
    EXPECT_EQ(perception::colour_strength(grey, colour, {1.0, 1.0}), 0.0) << int{colour};
  }
}

}  // namespace
}  // namespace constrictor
