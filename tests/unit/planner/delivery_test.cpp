// What counts as delivered, and what the planner does with an object that it cannot deliver.
#include <gtest/gtest.h>

#include "planner/delivery.hpp"
#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

class DeliveryTest : public PlannerTest {
 protected:
  /// Green is released, and the task ends.
  void release_green() {
    find_line();
    fetch(msg::kColourGreen);
    carry();
    release(msg::kColourGreen);
    succeed(msg::kEventDroppingDone);
  }
  /// Finds, reaches and pregrasps the object, which navigation passes on `side`; then the pregrasp or grasp fails.
  void fail_once(std::uint8_t side) {
    if (memory_.state == kApproachAnew) succeed(msg::kEventNone);
    if (memory_.state == kSearchObject) succeed(msg::kEventObjectFound);
    succeed(msg::kEventObjectReached);
    ASSERT_EQ(memory_.state, kPregrasp);
    asked_.push_back(last_.parameters.direction);
    status_.parameters.direction = side;
    steps(5);
    status_.parameters.direction = msg::kDirectionNone;
    abort(msg::kEventObjectPregraspLost);
  }
  void see_object(std::uint8_t colour) {
    see_line(true);
    see(colour, msg::kBlobObject, 1.2);
    steps(4);
    if (memory_.state != kTrackObject) steps(4);
    ASSERT_EQ(memory_.state, kTrackObject);
    ASSERT_EQ(last_.parameters.object_colour, colour);
  }
  /// A further object, `offset_m` from the centre of the zone of map_dropped().
  void add_object(std::uint16_t handle, double offset_m, double sd_m) {
    map_.objects[map_.object_count] = map_.objects[1];
    msg::MapObject& object = map_.objects[map_.object_count++];
    object.handle = handle;
    object.x_m = pose_.x_m + offset_m;
    object.sd_m = sd_m;
  }
  [[nodiscard]] Delivery verdict(std::uint16_t handle, std::uint16_t newest = 2) const {
    return view_delivery(map_, {msg::kColourGreen, handle, newest, -100}, 0.12, 0.3).verdict;
  }
  std::vector<std::uint8_t> asked_;
};

TEST_F(DeliveryTest, IsUndecidedUntilAnImageShowsTheObject) {
  release_green();
  EXPECT_EQ(memory_.state, kInspect);
  EXPECT_EQ(last_.task, msg::kTaskSearchObject);
  EXPECT_EQ(last_.parameters.object_colour, msg::kColourGreen);
  map_dropped(msg::kColourGreen, 0.1);
  map_.objects[1].last_seen_tick = memory_.released_tick + 3;  // the release itself, not a sighting
  steps(20);
  EXPECT_EQ(memory_.state, kInspect);
  map_.objects[1].last_seen_tick = tick_;
  step();
  EXPECT_EQ(memory_.state, kTurnRound);
  EXPECT_EQ(memory_.object_index, 1);
  EXPECT_EQ(memory_.recoveries, 0);
}

// An object that images show outside of its zone, even by 0.05 m, is not delivered.
TEST_F(DeliveryTest, AnObjectSeenOutsideItsZoneIsRetrievedAgain) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  release(msg::kColourGreen);
  map_dropped(msg::kColourGreen, 0.1);  // the arms push it on while they leave it
  succeed(msg::kEventDroppingDone);
  EXPECT_EQ(memory_.state, kInspect);
  steps(20);
  EXPECT_EQ(memory_.state, kInspect);
  map_dropped(msg::kColourGreen, 0.45);
  step();
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_EQ(memory_.object_index, 0);
  EXPECT_EQ(memory_.recoveries, 1);
  succeed(msg::kEventObjectFound);
  EXPECT_EQ(memory_.state, kTrackObject);
}

TEST_F(DeliveryTest, AtTheBorderTheLookEndsWithTheLikelierCase) {
  for (const double offset_m : {0.36, 0.38, 0.42}) {
    forget();
    release_green();
    for (int i = 0; i < 950; ++i) {  // inspect_s is 20 s
      map_dropped(msg::kColourGreen, offset_m);
      step();
      ASSERT_EQ(memory_.state, kInspect) << offset_m;
    }
    for (int i = 0; i < 100 && memory_.state == kInspect; ++i) step();
    EXPECT_EQ(memory_.state, offset_m < 0.37 ? kTurnRound : kSearchObject);  // the rim counts as outside
  }
}

TEST_F(DeliveryTest, AnUnseenObjectIsSearchedForAndCountsWhenItIsSeenOnItsZone) {
  release_green();
  for (int i = 0; i < 1100 && memory_.state == kInspect; ++i) step();
  EXPECT_EQ(memory_.state, kSearchObject);
  steps(20);
  EXPECT_EQ(memory_.state, kSearchObject);
  map_dropped(msg::kColourGreen, 0.2);
  step();
  EXPECT_EQ(memory_.state, kTurnRound);
  EXPECT_EQ(memory_.object_index, 1);
}

TEST_F(DeliveryTest, WithoutAKnownRadiusTheConfiguredOneCounts) {
  map_dropped(msg::kColourGreen, 0.35, 0.01);
  EXPECT_EQ(verdict(0), Delivery::kOnZone);
  map_.objects[0].radius_m = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(verdict(0), Delivery::kOutside);
  map_.objects[0].colour = msg::kColourRed;
  EXPECT_EQ(verdict(0), Delivery::kUnseen) << "the map has no zone of this colour";
}

TEST_F(DeliveryTest, OfSeveralZonesOfOneColourTheBestKnownOneCounts) {
  map_dropped(msg::kColourGreen, 0.9);
  map_.objects[map_.object_count] = map_.objects[0];
  msg::MapObject& phantom = map_.objects[map_.object_count++];
  phantom.handle = 7;
  phantom.x_m = pose_.x_m + 0.9;
  phantom.sd_m = 0.09;
  EXPECT_EQ(verdict(2), Delivery::kOutside);
}

TEST_F(DeliveryTest, TheHandleTellsObjectsOfOneColourApart) {
  map_dropped(msg::kColourGreen, 0.1);
  add_object(3, 2.0, 0.01);
  EXPECT_EQ(verdict(2, 3), Delivery::kOnZone);
  EXPECT_EQ(verdict(3, 3), Delivery::kOutside);
}

// The object has left the open body farther than the map expected: the map keeps the old landmark and adds a new one.
TEST_F(DeliveryTest, AMorePreciseNewLandmarkIsTheDroppedObject) {
  map_dropped(msg::kColourGreen, 0.7, 0.1);
  EXPECT_EQ(verdict(2, 2), Delivery::kOutside);
  add_object(5, 0.1, 0.04);
  EXPECT_EQ(verdict(2, 2), Delivery::kOnZone);
  EXPECT_EQ(verdict(2, 5), Delivery::kOutside) << "landmark 5 was there before the release: another object";
}

TEST_F(DeliveryTest, AGlimpseOfAnObjectWhosePlaceIsUncertainIsNotASighting) {
  map_dropped(msg::kColourGreen, 0.1, 0.05);
  EXPECT_EQ(verdict(2), Delivery::kOnZone);
  map_.objects[1].sd_m = 0.2;
  EXPECT_EQ(verdict(2), Delivery::kUncertain);
  map_.objects[1].x_m += 5.0;
  EXPECT_EQ(verdict(2), Delivery::kUncertain);
}

// The robot is so uncertain of its own place that nothing in its map is precise. An object that the map
// shows 0.34 m from the centre may lie outside of its zone of 0.4 m.
TEST_F(DeliveryTest, AnUncertainObjectThatStaysInViewIsJudgedByTheMap) {
  for (const double offset_m : {0.1, 0.25, 0.34, 0.7}) {
    forget();
    release_green();
    map_dropped(msg::kColourGreen, offset_m, 0.3);
    steps(20);
    ASSERT_EQ(memory_.state, kInspect);
    map_dropped(msg::kColourGreen, offset_m, 0.3);
    succeed(msg::kEventObjectFound);
    EXPECT_EQ(memory_.state, offset_m < 0.3 ? kTurnRound : kSearchObject) << offset_m;
  }
}

// Navigation has found the object in the newest image, which reaches the map a little later.
TEST_F(DeliveryTest, TheLookGoesOnUntilTheMapHasTheObject) {
  release_green();
  steps(20);
  succeed(msg::kEventObjectFound);
  EXPECT_EQ(memory_.state, kInspect);
  EXPECT_EQ(memory_.recoveries, 0);
  map_dropped(msg::kColourGreen, 0.1);
  step();
  EXPECT_EQ(memory_.state, kTurnRound);
}

// So near to the object the image cuts it, and no image gives its place to the map.
TEST_F(DeliveryTest, TheRobotStepsBackFromAnObjectThatIsInViewAndNotInTheMap) {
  release_green();
  steps(20);
  for (int look = 0; look < 2; ++look) {
    ASSERT_EQ(last_.task, msg::kTaskSearchObject);
    succeed(msg::kEventObjectFound);
    step();
  }
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionBackwards);
  const double from_s = time_s_;
  for (int i = 0; i < 200 && last_.task == msg::kTaskExplore; ++i) step();
  EXPECT_NEAR(time_s_ - from_s, config_.step_back_s, 0.1);
  EXPECT_EQ(last_.task, msg::kTaskSearchObject) << "it looks again";

  // The same once more, and then another way: to search for the object and to track it.
  for (int look = 0; look < 2; ++look) {
    succeed(msg::kEventObjectFound);
    step();
  }
  ASSERT_EQ(last_.task, msg::kTaskExplore);
  for (int i = 0; i < 200 && last_.task == msg::kTaskExplore; ++i) step();
  succeed(msg::kEventObjectFound);
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_LT(time_s_ - from_s, config_.inspect_s - 2.0);
}

TEST_F(DeliveryTest, AnUncertainObjectThatIsOnlyGlimpsedIsSearchedFor) {
  release_green();
  map_dropped(msg::kColourGreen, 0.1, 0.3);
  for (int i = 0; i < 1100 && memory_.state == kInspect; ++i) step();
  EXPECT_EQ(memory_.state, kSearchObject);
}

TEST_F(DeliveryTest, AnotherObjectOfTheColourFarFromTheZoneIsNotTakenForTheDeliveredOne) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  drop(msg::kColourGreen);
  for (int i = 0; i < 100; ++i) {
    map_dropped(msg::kColourGreen, 0.1);
    add_object(9, 3.0, 0.01);
    step();
  }
  EXPECT_EQ(memory_.delivered, 1u);
}

TEST_F(DeliveryTest, EachRetryPassesTheObjectOnTheOtherSide) {
  find_line();
  drive(4.0);
  see_object(msg::kColourGreen);
  fail_once(msg::kDirectionLeft);
  fail_once(msg::kDirectionRight);
  fail_once(msg::kDirectionLeft);
  EXPECT_EQ(asked_, (std::vector<std::uint8_t>{msg::kDirectionNone, msg::kDirectionRight, msg::kDirectionLeft}));
}

TEST_F(DeliveryTest, AnObjectThatResistsIsPutAsideAndTriedOnceMoreAtTheEnd) {
  config_.attempts = 2;
  find_line();
  drive(4.0);
  see_object(msg::kColourGreen);
  fail_once(msg::kDirectionLeft);
  fail_once(msg::kDirectionRight);
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  EXPECT_EQ(memory_.object_index, 1) << "red is next";
  see_nothing();
  face(0.0);
  find_line();
  fetch(msg::kColourRed);
  carry();
  drop(msg::kColourRed);
  EXPECT_EQ(memory_.state, kTurnRound);
  EXPECT_EQ(memory_.object_index, 0) << "green once more";
  find_line();
  see_object(msg::kColourGreen);
  fail_once(msg::kDirectionLeft);
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_EQ(memory_.reason, "not delivered: green (3 attempts failed, the last in pregrasp: object pregrasp lost)");
}

TEST_F(DeliveryTest, TheSecondAttemptAtTheEndMaySucceed) {
  config_.attempts = 1;
  find_line();
  drive(4.0);
  see_object(msg::kColourGreen);
  fail_once(msg::kDirectionLeft);
  see_nothing();
  face(0.0);
  for (const std::uint8_t colour : {msg::kColourRed, msg::kColourGreen}) {
    find_line();
    fetch(colour);
    carry();
    drop(colour);
  }
  EXPECT_EQ(memory_.state, kDone);
}

}  // namespace
}  // namespace constrictor
