// The trackers of line, objects and zones: debouncing over images, and positions in the map.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "navigation/line_tracker.hpp"
#include "navigation/object_tracker.hpp"

namespace constrictor {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A straight line seen from beside: y = offset + slope x.
msg::LinePercept straight_line(double offset_m, double slope) {
  msg::LinePercept percept{};
  percept.visible = true;
  percept.colour = msg::kColourBlue;
  percept.point_count = 8;
  for (int i = 0; i < 8; ++i) {
    percept.x_m[i] = 0.15 + 0.1 * i;
    percept.y_m[i] = offset_m + slope * percept.x_m[i];
  }
  percept.heading_rad = std::atan(slope);
  percept.end_distance_m = kNan;
  return percept;
}

TEST(LineTracker, TakesTheOffsetAtTheLookahead) {
  EXPECT_NEAR(line_offset_m(straight_line(0.1, 0.5), 0.37), 0.1 + 0.5 * 0.37, 1e-12);
  EXPECT_TRUE(std::isnan(line_offset_m(msg::LinePercept{}, 0.37)));
}

TEST(LineTracker, IsVisibleAndLostAfterTheConfiguredNumberOfImages) {
  LineTrackerConfig config;
  config.lost_after = 5;
  LineTrackerState state;
  msg::LinePercept none{};
  none.colour = msg::kColourBlue;
  for (int i = 0; i < 2; ++i) update_line_tracker(config, straight_line(0, 0), msg::kColourBlue, state);
  EXPECT_FALSE(state.visible);
  update_line_tracker(config, straight_line(0, 0), msg::kColourBlue, state);
  EXPECT_TRUE(state.visible);
  for (int i = 0; i < 4; ++i) update_line_tracker(config, none, msg::kColourBlue, state);
  EXPECT_TRUE(state.visible);
  update_line_tracker(config, none, msg::kColourBlue, state);
  EXPECT_FALSE(state.visible);
}

TEST(LineTracker, IgnoresALineOfAnotherColour) {
  LineTrackerState state;
  for (int i = 0; i < 20; ++i) update_line_tracker({}, straight_line(0, 0), msg::kColourGreen, state);
  EXPECT_FALSE(state.visible);
}

msg::ObjectPercepts one_blob(std::uint8_t kind, double bearing_rad, double range_m, double width_m) {
  msg::ObjectPercepts percepts{};
  percepts.blob_count = 1;
  msg::Blob& blob = percepts.blobs[0];
  blob.colour = msg::kColourGreen;
  blob.kind = kind;
  blob.bearing_rad = bearing_rad;
  blob.range_m = range_m;
  blob.width_m = width_m;
  blob.area_fraction = 0.01;
  return percepts;
}

TEST(ObjectTracker, PlacesAnObjectByThePoseAtTheExposureOfTheImage) {
  ObjectTrackerState state;
  remember_pose(10, {{1.0, 2.0}, 1.57079632679}, state);
  remember_pose(20, {{5.0, 5.0}, 0.0}, state);
  msg::ObjectPercepts percepts = one_blob(msg::kBlobObject, 0.0, 0.9, 0.2);
  percepts.exposure_tick = 11;
  ObjectTrackerConfig config;
  for (int i = 0; i < 50; ++i) update_object_tracker(config, percepts, state);
  const Sighting& seen = state.objects[msg::kColourGreen];
  EXPECT_TRUE(seen.visible);
  EXPECT_NEAR(seen.radius_m, 0.1, 1e-3);
  EXPECT_NEAR(seen.x_m, 1.0, 1e-3);
  EXPECT_NEAR(seen.y_m, 2.0 + 0.9 + 0.1, 1e-3);  // looking along +y
  EXPECT_FALSE(state.zones[msg::kColourGreen].known);
}

TEST(ObjectTracker, AnUndecidedBlobKeepsAVisibleZoneVisibleAndDoesNotMoveIt) {
  ObjectTrackerState state;
  remember_pose(0, {}, state);
  for (int i = 0; i < 5; ++i) update_object_tracker({}, one_blob(msg::kBlobZone, 0.0, 1.0, 0.6), state);
  const double x_m = state.zones[msg::kColourGreen].x_m;
  msg::ObjectPercepts undecided = one_blob(msg::kBlobUndecided, 0.4, 0.3, 0.6);
  undecided.blobs[0].cut_bottom = true;
  for (int i = 0; i < 30; ++i) update_object_tracker({}, undecided, state);
  EXPECT_TRUE(state.zones[msg::kColourGreen].visible);
  EXPECT_EQ(state.zones[msg::kColourGreen].x_m, x_m);
}

TEST(ObjectTracker, AMovedObjectGetsItsNewPositionAtOnce) {
  ObjectTrackerState state;
  remember_pose(0, {}, state);
  for (int i = 0; i < 50; ++i) update_object_tracker({}, one_blob(msg::kBlobObject, 0.0, 1.0, 0.17), state);
  update_object_tracker({}, one_blob(msg::kBlobObject, 0.0, 2.0, 0.17), state);
  EXPECT_NEAR(state.objects[msg::kColourGreen].x_m, 2.0 + 0.085, 1e-2);
}

TEST(ObjectTracker, ForgetsAPlaceThatTheMapHasGivenUp) {
  ObjectTrackerConfig config;
  ObjectTrackerState state;
  const auto images = [&](const msg::ObjectPercepts& percepts, int count) {
    for (int i = 0; i < count; ++i) update_object_tracker(config, percepts, state);
  };
  images(one_blob(msg::kBlobObject, 0.0, 1.0, 0.16), 10);
  const std::uint8_t colour = one_blob(msg::kBlobObject, 0.0, 1.0, 0.16).blobs[0].colour;
  const Sighting& object = state.objects[colour];
  msg::FieldMap map{};
  forget_dropped(config, map, state);
  EXPECT_TRUE(object.known) << "the map does not have it yet";
  map.object_count = 1;
  map.objects[0] = {5, colour, msg::kBlobObject, object.x_m + 0.1, object.y_m, 0.08, 0.03, false, false, 0};
  forget_dropped(config, map, state);
  map.objects[0].x_m += 3.0;  // carried away by the robot itself: it keeps its handle
  images({}, 20);
  forget_dropped(config, map, state);
  EXPECT_TRUE(object.known);
  map.object_count = 0;
  forget_dropped(config, map, state);
  EXPECT_FALSE(object.known);
  images(one_blob(msg::kBlobObject, 0.0, 2.0, 0.16), 1);
  EXPECT_TRUE(object.known);
  EXPECT_NEAR(object.x_m, 2.08, 0.02) << "the old place has no part in the new one";
}

}  // namespace
}  // namespace constrictor
