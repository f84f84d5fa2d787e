// How a robot with an object comes to the zone: it turns in a circle, and not everything that looks like a zone is one.
#include <gtest/gtest.h>

#include <cmath>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

// A robot with an object cannot turn to a zone inside its turning circle: it drives on until the zone lies outside.
TEST_F(PlannerTest, DrivesOnBeforeItTurnsToAZoneWithinItsTurningCircle) {
  find_line();
  fetch(msg::kColourGreen);
  face(0.2);
  map_.object_count = 1;
  map_.objects[0] = {1,  msg::kColourGreen, msg::kBlobZone, pose_.x_m, pose_.y_m + 1.0, 0.3, 0.0, 0.03, false, false, 0,
                     0.0};
  see_line(true);
  for (int i = 0; i < 600; ++i) {
    if (const auto wanted = step()) {
      EXPECT_EQ(wanted->task, msg::kTaskExplore) << i;
      EXPECT_EQ(wanted->parameters.direction, msg::kDirectionForwards) << i;
    }
    ASSERT_EQ(memory_.state, kSearchLine) << "the line leads away from the zone";
  }
  map_.objects[0].y_m = pose_.y_m + 2.2;
  steps(110);
  EXPECT_EQ(last_.task, msg::kTaskRotate);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionLeft);
}

TEST_F(PlannerTest, DoesNotTurnBackAgainAtOnceIfThatWasInVain) {
  find_line();
  fetch(msg::kColourGreen);
  face(0.2);
  see_line(true);
  steps(4);
  ASSERT_EQ(memory_.state, kTurnBack);
  const double from_s = time_s_;
  while (memory_.state == kTurnBack && time_s_ < from_s + 100.0) step();
  ASSERT_EQ(memory_.state, kSearchLine);
  EXPECT_NEAR(time_s_ - from_s, config_.turn_back_s, 1.0);
  const double since_s = time_s_;
  while (memory_.state == kSearchLine && time_s_ < since_s + 100.0) {
    pose_.y_m = 0.4 * std::sin(time_s_);  // it is not caught
    step();
  }
  EXPECT_EQ(memory_.state, kTurnBack);
  EXPECT_NEAR(time_s_ - since_s, config_.any_way_s * config_.holding_factor, 1.0);
}

// A robot at the wrong end of a short line turns back twice at most, and then searches without the line.
TEST_F(PlannerTest, SearchesWithoutTheLineAfterTurningBackWasInVainTwice) {
  find_line();
  fetch(msg::kColourGreen);
  face(0.2);
  see_line(true);
  int turns = 0;
  double since_s = time_s_, farthest_m = 0.0;
  for (MissionState before = memory_.state; time_s_ < since_s + 400.0; before = memory_.state) {
    if (memory_.state == kSearchLine && turns == 2) {
      // It drives as requested.
      const bool turn = last_.task == msg::kTaskRotate;
      const double side = last_.parameters.direction == msg::kDirectionLeft    ? 1.0
                          : last_.parameters.direction == msg::kDirectionRight ? -1.0
                                                                               : 0.0;
      const double yaw_rad = pose_.yaw_rad + side * (turn ? 0.006 : 0.003);
      face(yaw_rad);
      pose_.x_m += 0.005 * std::cos(yaw_rad);
      pose_.y_m += 0.005 * std::sin(yaw_rad);
      farthest_m = std::max(farthest_m, std::abs(pose_.y_m));
      see_line(std::cos(yaw_rad) > 0.6);  // when it leads to the objects
    } else {
      pose_.y_m = 0.2 * std::sin(time_s_);  // it is not caught
    }
    step();
    if (memory_.state == kTurnBack && before != kTurnBack) ++turns;
    if (turns < 2) since_s = time_s_;
    ASSERT_TRUE(memory_.state == kSearchLine || memory_.state == kTurnBack) << name_of(memory_.state);
  }
  EXPECT_EQ(turns, 2);
  EXPECT_GT(farthest_m, 3.0) << "the square grows";

  see_zone(msg::kColourGreen, 0.8);
  steps(4);
  ASSERT_EQ(memory_.state, kDrop);
  status_.carrying = false;
  step({event(msg::kEventObjectGraspLost)});
  EXPECT_EQ(memory_.vain_turns, 0) << "the next load begins anew";
}

// The percepts show a zone earlier than the map does. The planner waits for the map, because navigation refuses to drop
// at a zone that the map does not have.
TEST_F(PlannerTest, FollowsTheLineUntilTheMapKnowsTheZone) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see_line(true);
  see(msg::kColourGreen, msg::kBlobZone, 1.2);
  steps(20);
  EXPECT_EQ(memory_.state, kTransport);
  see_zone(msg::kColourGreen, 1.2);
  steps(1);
  EXPECT_EQ(memory_.state, kDrop);
}

// The map does not get a zone that the border of the image cuts: the robot then searches where images have shown it,
// for a limited time.
TEST_F(PlannerTest, SearchesWhereImagesHaveShownTheZone) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see(msg::kColourGreen, msg::kBlobZone, 1.2);
  objects_.blobs[0].bearing_rad = 0.7;
  steps(4);
  see_nothing();
  succeed(msg::kEventEndOfLine);
  ASSERT_EQ(memory_.state, kSearchLine);
  steps(4);
  EXPECT_TRUE(memory_.search_by_memory);
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionLeft);
  for (double s = 0.0; s < 45.0; s += 0.02) step();
  EXPECT_FALSE(memory_.search_by_memory) << "it was no zone";
}

// An object that has fallen over may look like a second zone of its colour. The robot drops nothing there, unless its
// pose is so uncertain that the zone in view may be the known one.
TEST_F(PlannerTest, WhatLooksLikeASecondZoneIsNotOne) {
  find_line();
  fetch(msg::kColourGreen);
  map_.object_count = 1;
  map_.objects[0] = {1,  msg::kColourGreen, msg::kBlobZone, pose_.x_m - 3.0, pose_.y_m, 0.4, 0.0, 0.03, false, false, 0,
                     0.0};
  see_zone(msg::kColourGreen, 0.8);  // the head faces backwards along x
  steps(20);
  EXPECT_EQ(memory_.state, kSearchLine);
  see_zone(msg::kColourGreen, 1.6);  // nearer, but the pose is uncertain
  pose_.covariance[0] = 0.3 * 0.3;
  steps(4);
  EXPECT_EQ(memory_.state, kDrop);
}

// Each search begins with the moves that use the memory, however many moves earlier searches have made.
TEST_F(PlannerTest, ANewSearchBeginsWithWhatItRemembers) {
  find_line();
  memory_.searches = 13;
  memory_.searched_s = memory_.active_s - 11.0;
  fetch(msg::kColourGreen);
  EXPECT_TRUE(memory_.search_by_memory);
  EXPECT_EQ(memory_.searches, 1);
}

TEST_F(PlannerTest, AMoveThatIgnoresTheMemoryIsShort) {
  find_line();
  fetch(msg::kColourGreen);
  memory_.searches = 12;
  memory_.requested = false;
  const double from_s = time_s_;
  step();
  ASSERT_FALSE(memory_.search_by_memory);
  const std::uint64_t goal = memory_.goals;
  while (memory_.goals == goal && time_s_ - from_s < 60.0) step();
  EXPECT_NEAR(time_s_ - from_s, config_.explore_s, 0.2) << "holding_factor does not count";
}

}  // namespace
}  // namespace constrictor
