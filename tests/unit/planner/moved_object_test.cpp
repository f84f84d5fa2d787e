// Where a delivered object is that the robot may have pushed off its zone, and what the planner does then.
#include <gtest/gtest.h>

#include "planner/delivery.hpp"
#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

constexpr double kSeenSd_m = 0.12, kZoneRadius_m = 0.3;

msg::MapObject landmark(std::uint8_t kind, std::uint16_t handle, double x_m, double sd_m, std::int64_t seen_tick) {
  msg::MapObject made{};
  made.colour = msg::kColourGreen;
  made.kind = kind;
  made.handle = handle;
  made.x_m = x_m;
  made.radius_m = kZoneRadius_m;
  made.sd_m = sd_m;
  made.last_seen_tick = seen_tick;
  return made;
}

class MovedObjectTest : public ::testing::Test {
 protected:
  MovedObjectTest() {
    map_.objects[0] = landmark(msg::kBlobZone, 1, 0.0, 0.03, 100);
    map_.objects[1] = landmark(msg::kBlobObject, 2, 0.1, 0.03, 100);  // precise, where the robot has delivered it
    map_.object_count = 3;
  }
  /// The verdict if the map also has an object at `x_m` that was seen later.
  Delivery with_another(double x_m, double sd_m) {
    map_.objects[2] = landmark(msg::kBlobObject, 5, x_m, sd_m, 200);
    return view_delivery(map_, dropped_, kSeenSd_m, kZoneRadius_m).verdict;
  }
  msg::FieldMap map_{};
  DroppedObject dropped_{msg::kColourGreen, 2, 2, -100, true};
};

TEST_F(MovedObjectTest, IsWhereItWasSeenLast) {
  EXPECT_EQ(with_another(0.9, 0.1), Delivery::kOutside);
  EXPECT_EQ(with_another(0.1, 0.1), Delivery::kOnZone);
  dropped_.may_have_moved = false;
  EXPECT_EQ(with_another(0.9, 0.1), Delivery::kOnZone) << "the more precise landmark counts";
}

TEST_F(MovedObjectTest, AGlimpseCountsOnlyIfItIsClearlyOutsideOfTheZone) {
  EXPECT_EQ(with_another(0.8, 0.2), Delivery::kOnZone) << "2.5 standard deviations outside";
  EXPECT_EQ(with_another(1.2, 0.2), Delivery::kOutside) << "4.5 standard deviations outside";
}

// An object may hide another one of its colour on the zone, and the two may exchange their handles in the map: they
// count as delivered if one is in view there and the hidden one was last seen there.
TEST_F(MovedObjectTest, TwoObjectsOfOneColourOnTheirZoneAreBothThere) {
  const auto both = [&](double dropped_m, double sd_m, double twin_m, std::int64_t twin_seen) {
    map_.objects[1] = landmark(msg::kBlobObject, 2, dropped_m, sd_m, -150);  // hidden since the drop
    map_.objects[2] = landmark(msg::kBlobObject, 1, twin_m, 0.05, twin_seen);
    dropped_.others = {1};
    EXPECT_EQ(view_delivery(map_, dropped_, kSeenSd_m, kZoneRadius_m).verdict, Delivery::kUnseen);
    return all_on_zone(map_, dropped_, kSeenSd_m, kZoneRadius_m);
  };
  EXPECT_TRUE(both(-0.15, 0.08, 0.15, 100));
  EXPECT_FALSE(both(-0.15, 0.08, 0.15, -150)) << "nothing was seen after the drop";
  EXPECT_FALSE(both(-0.15, 0.2, 0.15, 100)) << "the place of the hidden one is uncertain";
  EXPECT_FALSE(both(-0.5, 0.08, 0.15, 100)) << "it was last seen outside";
  EXPECT_FALSE(both(-0.15, 0.08, 0.6, 100)) << "the other one is outside";
  map_.objects[1].kind = msg::kBlobZone;
  EXPECT_FALSE(all_on_zone(map_, dropped_, kSeenSd_m, kZoneRadius_m)) << "there is only one object";
}

class PushedObjectTest : public PlannerTest {
 protected:
  /// Green is delivered; red is released, and the robot looks at it.
  void deliver_green_and_release_red() {
    find_line();
    fetch(msg::kColourGreen);
    carry();
    drop(msg::kColourGreen);
    ASSERT_EQ(memory_.delivered, 1u);
    face(0.0);
    find_line();
    fetch(msg::kColourRed);
    carry();
    release(msg::kColourRed);
    succeed(msg::kEventDroppingDone);
    ASSERT_EQ(memory_.state, kInspect);
  }
  /// Red is in the middle of its zone; green is `offset_m` from the centre of its own, which has a radius of 0.4 m.
  void map_red_and_green(double offset_m, double sd_m) {
    map_dropped(msg::kColourRed, 0.1);
    map_.object_count = 4;
    map_.objects[2] = map_.objects[0];
    map_.objects[3] = map_.objects[1];
    map_.objects[2].colour = map_.objects[3].colour = msg::kColourGreen;
    map_.objects[2].handle = 3;
    map_.objects[3].handle = 9;  // a new landmark: the object is too far from its old place
    map_.objects[2].y_m = map_.objects[3].y_m = pose_.y_m + 1.0;
    map_.objects[3].x_m = pose_.x_m + offset_m;
    map_.objects[3].sd_m = sd_m;
  }
};

// The robot may push the green object off its zone while it carries the red one. The mission has not succeeded then.
TEST_F(PushedObjectTest, ADeliveredObjectThatWasPushedOffItsZoneIsRetrievedAgain) {
  deliver_green_and_release_red();
  for (int i = 0; i < 70 && memory_.state == kInspect; ++i) {
    map_red_and_green(0.8, 0.03);
    step();
  }
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_EQ(memory_.object_index, 0) << "green once more";
  EXPECT_EQ(memory_.delivered, 2u);
  EXPECT_EQ(memory_.recoveries, 1);
  succeed(msg::kEventObjectFound);
  EXPECT_EQ(last_.parameters.object_colour, msg::kColourGreen);
}

// An object that is pushed off its zone again and again must not use up the time of the mission.
TEST_F(PushedObjectTest, AnObjectThatIsPushedOffAgainAndAgainIsPutAside) {
  deliver_green_and_release_red();
  memory_.attempts.resize(1);
  memory_.attempts[0].failures = config_.attempts - 1;
  for (int i = 0; i < 70 && memory_.state == kInspect; ++i) {
    map_red_and_green(0.8, 0.03);
    step();
  }
  EXPECT_EQ(memory_.aside, 0U) << "in the second pass it is tried once more";
  EXPECT_TRUE(memory_.second_pass);
  EXPECT_EQ(memory_.object_index, 0);
  EXPECT_EQ(memory_.attempts[0].failures, config_.attempts);
  EXPECT_EQ(memory_.attempts[0].reason, "delivered: it was pushed off its zone");
}

// The robot has touched the green object while it carried the red one, so that its place is uncertain at the end.
TEST_F(PushedObjectTest, BeforeTheEndTheRobotLooksOnceMoreAtADeliveredObjectThatItTouched) {
  for (const double offset_m : {0.1, 0.7}) {
    forget();
    deliver_green_and_release_red();
    memory_.placed.at(0).handle = 9;  // as navigation reports it
    expect_second_look(0.1, offset_m, 9, [this](double first_m, double sd_m) { map_red_and_green(first_m, sd_m); });
    EXPECT_EQ(memory_.recoveries, offset_m < 0.4 ? 0 : 1);
  }
}

// The robot has touched the green object after it saw it on its zone. A look from afar has made the map certain since,
// but it may have been wrong about so small a move.
TEST_F(PushedObjectTest, ATouchIsRememberedUntilTheRobotHasLookedFromNearBy) {
  for (const bool touched : {true, false}) {
    forget();
    deliver_green_and_release_red();
    memory_.placed.at(0).handle = 9;
    map_red_and_green(0.1, 0.03);
    map_.touch_count = 1;
    map_.touches[0].handle = touched ? 9 : 1;
    map_.touches[0].tick = memory_.placed.at(0).tick + 1;
    step();
    map_.touch_count = 0;  // touches stay in the map for a few seconds only
    for (int i = 0; i < 70 && memory_.object_index == 1 && memory_.state == kInspect; ++i) {
      map_red_and_green(0.1, 0.03);
      step();
    }
    if (!touched) {
      EXPECT_EQ(memory_.state, kDone);
      continue;
    }
    ASSERT_EQ(memory_.state, kInspect);
    EXPECT_EQ(memory_.object_index, 0) << "green once more";
    for (int i = 0; i < 200 && memory_.state == kInspect; ++i) {
      map_red_and_green(0.7, 0.03);
      step();
    }
    EXPECT_EQ(memory_.state, kSearchObject) << "it lies outside its zone";
    EXPECT_EQ(memory_.delivered, 2u);
  }
}

// The body has swept the green object 2.4 m away. The map may still have it on its zone, which no image has shown
// since.
TEST_F(PushedObjectTest, AnObjectThatAppearsFarAwayMayBeTheDeliveredOne) {
  for (const bool still_mapped : {true, false}) {
    forget();
    deliver_green_and_release_red();
    memory_.placed.at(0).handle = 8;
    for (int i = 0; i < 70 && memory_.state == kInspect && memory_.object_index == 1; ++i) {
      map_red_and_green(2.4, 0.03);
      map_.objects[4] = map_.objects[3];
      map_.objects[4].handle = 8;
      map_.objects[4].x_m = pose_.x_m + 0.1;
      map_.objects[4].last_seen_tick = tick_ - 3000;
      map_.object_count = still_mapped ? 5 : 4;
      step();
    }
    EXPECT_EQ(memory_.object_index, 0) << still_mapped;
    EXPECT_EQ(memory_.state, still_mapped ? kInspect : kSearchObject) << "where the map still has it, it looks first";
    EXPECT_EQ(memory_.delivered, 2u);
  }
}

}  // namespace
}  // namespace constrictor
