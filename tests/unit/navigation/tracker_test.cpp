// The trackers of line, objects and zones: debouncing over images, and positions in the map.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "navigation/line_tracker.hpp"
#include "navigation/navigation_config.hpp"
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

msg::ObjectPercepts one_blob(std::uint8_t kind, std::int64_t exposure_tick = 0) {
  msg::ObjectPercepts percepts{};
  percepts.exposure_tick = exposure_tick;
  percepts.blob_count = 1;
  percepts.blobs[0].colour = msg::kColourGreen;
  percepts.blobs[0].kind = kind;
  return percepts;
}

void images(const msg::ObjectPercepts& percepts, int count, ObjectTrackerState& state) {
  for (int i = 0; i < count; ++i) update_visibility({}, percepts, state);
}

msg::MapObject landmark(std::uint16_t handle, std::uint8_t kind, double x_m, double y_m, double radius_m = 0.08) {
  return {handle, msg::kColourGreen,
          kind,   x_m,
          y_m,    radius_m,
          0.15,   0.03,
          false,  false,
          0,      kind == msg::kBlobObject ? 1.0 : 0.0};
}

msg::FieldMap map_of(const std::vector<msg::MapObject>& landmarks) {
  msg::FieldMap map{};
  for (const auto& one : landmarks) map.objects[map.object_count++] = one;
  return map;
}

TEST(ObjectTracker, AnUndecidedBlobKeepsAVisibleZoneVisible) {
  ObjectTrackerState state;
  const Sighting& zone = state.zones[msg::kColourGreen];
  images(one_blob(msg::kBlobUndecided), 30, state);
  EXPECT_FALSE(zone.visible);
  EXPECT_EQ(zone.seen_tick, -1);
  images(one_blob(msg::kBlobZone), 5, state);
  EXPECT_TRUE(zone.visible);
  EXPECT_TRUE(zone.decided);
  images(one_blob(msg::kBlobUndecided, 70), 30, state);
  EXPECT_TRUE(zone.visible);
  EXPECT_FALSE(zone.decided);
  EXPECT_EQ(zone.seen_tick, 70);
  images({}, 30, state);
  EXPECT_FALSE(zone.visible);
}

TEST(ObjectTracker, APlaceIsThatOfTheLandmark) {
  ObjectTrackerState state;
  const Sighting& object = state.objects[msg::kColourGreen];
  images(one_blob(msg::kBlobObject), 5, state);
  take_places({}, map_of({}), {0.0, 0.0}, 0, state);
  EXPECT_FALSE(object.known) << "the map does not have it yet";
  take_places({}, map_of({landmark(5, msg::kBlobObject, 1.0, 2.0, 0.06), landmark(6, msg::kBlobZone, 3.0, 4.0, 0.3)}),
              {0.0, 0.0}, 0, state);
  EXPECT_TRUE(object.known);
  EXPECT_EQ(object.handle, 5);
  EXPECT_EQ(object.p_M(), Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(object.radius_m, 0.06);
  EXPECT_EQ(object.height_m, 0.15);
  EXPECT_EQ(state.zones[msg::kColourGreen].p_M(), Eigen::Vector2d(3.0, 4.0));
  EXPECT_EQ(state.zones[msg::kColourGreen].radius_m, 0.3);
  msg::MapObject unmeasured = landmark(5, msg::kBlobObject, 1.0, 2.0, kNan);
  unmeasured.height_m = kNan;
  take_places({}, map_of({unmeasured, landmark(6, msg::kBlobZone, 3.0, 4.0, 9.0)}), {0.0, 0.0}, 0, state);
  EXPECT_EQ(object.radius_m, ObjectTrackerConfig().object_radius_m) << "no image has shown its width";
  EXPECT_EQ(object.height_m, 0.0) << "nor its height";
  EXPECT_EQ(state.zones[msg::kColourGreen].radius_m, kZoneRadiusBounds_m.max) << "no zone is larger";
  take_places({}, map_of({}), {0.0, 0.0}, 0, state);
  EXPECT_FALSE(object.known) << "the map has given it up";
  EXPECT_EQ(object.handle, 0);
}

// A zone of 0.8 m was taken for one of 0.6 m, although a scenario may have it.
TEST(ObjectTracker, AZoneHasTheRadiusThatTheMapShowsIfAScenarioMayHaveIt) {
  ObjectTrackerState state;
  for (const double radius_m : {kZoneRadiusBounds_m.min, 0.05, 0.8, kZoneRadiusBounds_m.max}) {
    ObjectTrackerConfig config;
    take_places(config, map_of({landmark(6, msg::kBlobZone, 3.0, 4.0, radius_m)}), {0.0, 0.0}, 0, state);
    EXPECT_EQ(state.zones[msg::kColourGreen].radius_m, radius_m);
    config.zone_radius_m = radius_m;  // the mission states it, and no image has shown it
    take_places(config, map_of({landmark(6, msg::kBlobZone, 3.0, 4.0, kNan)}), {0.0, 0.0}, 0, state);
    EXPECT_EQ(state.zones[msg::kColourGreen].radius_m, radius_m);
  }
}

TEST(ObjectTracker, TheUsualRadiiAreThoseThatTheMissionStates) {
  NavigationConfig config;
  config.know({});
  EXPECT_EQ(config.object.object_radius_m, 0.085);
  EXPECT_EQ(config.object.zone_radius_m, 0.3);
  PriorKnowledge known;
  known.object_radius_m = 0.12;
  known.zone_radius_m = 0.5;
  config.know(known);
  EXPECT_EQ(config.object.object_radius_m, 0.12) << "as guidance: both match touches with objects";
  EXPECT_EQ(config.object.zone_radius_m, 0.5);
}

TEST(ObjectTracker, OfSeveralObjectsTheNamedOneOrTheNearestInViewCounts) {
  ObjectTrackerState state;
  const Sighting& object = state.objects[msg::kColourGreen];
  images(one_blob(msg::kBlobObject), 5, state);
  std::vector<msg::MapObject> twins = {landmark(1, msg::kBlobObject, 1.0, 0.0), landmark(2, msg::kBlobObject, 2.0, 0.0),
                                       landmark(3, msg::kBlobObject, 0.5, 0.0)};
  twins[0].last_seen_tick = twins[1].last_seen_tick = 100;
  twins[2].last_seen_tick = 60;  // it is not in view
  const auto counting = [&](std::uint16_t named) {
    take_places({}, map_of(twins), {0.0, 0.0}, named, state);
    return object.handle;
  };
  EXPECT_EQ(counting(0), 1);
  EXPECT_EQ(counting(2), 2);
  EXPECT_EQ(counting(3), 1) << "a named object out of view is not the one that the images show";
  images({}, 20, state);
  EXPECT_EQ(counting(0), 1) << "out of view, the last one remains";
  EXPECT_EQ(counting(3), 3) << "unless another one is named";
  twins[2].carried = true;
  EXPECT_EQ(counting(3), 1) << "what the robot carries does not stand anywhere";
}

// A blob that is too far away for the map may be any of several objects, also the one that was seen longest ago.
TEST(ObjectTracker, AnObjectThatIsSeenButNotInTheMapLeavesTheChoiceAsItWas) {
  ObjectTrackerState state;
  const Sighting& object = state.objects[msg::kColourGreen];
  std::vector<msg::MapObject> twins = {landmark(4, msg::kBlobObject, -4.0, 0.0),
                                       landmark(6, msg::kBlobObject, 3.5, 0.0)};
  twins[0].last_seen_tick = 600;
  twins[1].last_seen_tick = 100;
  images(one_blob(msg::kBlobObject, 1000), 5, state);
  ASSERT_TRUE(object.visible);
  const auto counting = [&](std::uint16_t named) {
    take_places({}, map_of(twins), {0.0, 0.0}, named, state);
    return object.handle;
  };
  EXPECT_EQ(counting(6), 6);
  EXPECT_EQ(counting(0), 6) << "the one that was named before";
  EXPECT_EQ(counting(4), 4);
  twins[1].last_seen_tick = 990;
  EXPECT_EQ(counting(4), 6) << "the map has the image by now";
}

}  // namespace
}  // namespace constrictor
