// The nominal mission: which objects it retrieves, and what it ignores.
#include <gtest/gtest.h>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

TEST_F(PlannerTest, RetrievesGreenThenRedAsInFigure3) {
  step();
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  for (const auto colour : config_.sequence) {
    find_line();
    fetch(colour);
    carry();
    drop(colour);
    if (colour == msg::kColourRed) break;
    EXPECT_EQ(memory_.state, kTurnRound);
    EXPECT_EQ(last_.task, msg::kTaskRotate);
    EXPECT_TRUE(std::isfinite(last_.parameters.timeout_s));
  }
  EXPECT_EQ(memory_.state, kDone);
  EXPECT_EQ(memory_.recoveries, 0);
  EXPECT_FALSE(step());
}

TEST_F(PlannerTest, SequencesOfOneToFourColoursAreRetrieved) {
  const std::vector<std::uint8_t> all = {msg::kColourRed, msg::kColourYellow, msg::kColourGreen, msg::kColourRed};
  for (std::size_t count = 1; count <= all.size(); ++count) {
    memory_ = {};
    taken_.clear();
    pose_ = {};
    config_.sequence.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count));
    for (const auto colour : config_.sequence) {
      find_line();
      fetch(colour);
      carry();
      drop(colour);
      ++object_;  // two objects of one colour have different landmarks
    }
    EXPECT_EQ(memory_.state, kDone);
  }
}

TEST_F(PlannerTest, MissionWithoutObjectsSucceedsAtTheEndOfTheLine) {
  config_.sequence.clear();
  find_line();
  EXPECT_EQ(last_.task, msg::kTaskFollowLine);
  see(msg::kColourGreen, msg::kBlobObject, 0.6);
  steps(10);
  EXPECT_EQ(memory_.state, kFollowLine) << "an object that is no part of the mission is ignored";
  succeed(msg::kEventEndOfLine);
  EXPECT_EQ(memory_.state, kDone);
  EXPECT_FALSE(step());
}

// Over a link that loses messages, the status may say that the goal has succeeded before the event arrives.
TEST_F(PlannerTest, AMissionWithoutObjectsNeedsNoEventAtTheEndOfTheLine) {
  config_.sequence.clear();
  find_line();
  succeed(msg::kEventNone);
  EXPECT_EQ(memory_.state, kDone);
}

// The robot drove beside the line for ten seconds, because it had passed the end of the line before the object.
TEST_F(PlannerTest, ARobotThatGraspsBehindTheEndOfTheLineFollowsTheLineBackAtOnce) {
  find_line();
  drive(4.0);
  succeed(msg::kEventEndOfLine);
  ASSERT_EQ(memory_.state, kSearchObject);
  succeed(msg::kEventObjectFound);
  ASSERT_EQ(memory_.state, kTrackObject);
  succeed(msg::kEventObjectReached);
  succeed(msg::kEventObjectPregrasped);
  see_nothing();
  status_.carrying = true;
  face(std::numbers::pi);
  succeed(msg::kEventObjectGrasped);
  ASSERT_EQ(memory_.state, kSearchLine);
  see_line(true);
  steps(4);
  EXPECT_EQ(memory_.state, kTransport);
}

TEST_F(PlannerTest, IgnoresZonesDistantObjectsAndObjectsOfAnotherColour) {
  find_line();
  see(msg::kColourRed, msg::kBlobObject, 0.6);
  steps(10);
  see_zone(msg::kColourGreen, 0.6);
  steps(10);
  see(msg::kColourGreen, msg::kBlobObject, 2.2);
  steps(10);
  see(msg::kColourGreen, msg::kBlobObject, std::numeric_limits<double>::quiet_NaN());
  steps(10);
  EXPECT_EQ(memory_.state, kFollowLine);
}

// Tables VII and IX: pregrasp and grasp name the object by the handle with which it was reached.
TEST_F(PlannerTest, PregraspsAndGraspsTheReachedObjectByItsHandle) {
  const auto succeed_with = [this](std::uint8_t what, std::uint16_t handle) {
    msg::TaskEvent e = event(what, msg::kGoalSucceeded);
    e.object_handle = handle;
    step({e});
  };
  find_line();
  drive(4.0);
  see(msg::kColourGreen, msg::kBlobObject, 1.2);
  steps(4);
  ASSERT_EQ(last_.task, msg::kTaskTrackObject);
  EXPECT_EQ(last_.parameters.object_handle, 0);
  succeed_with(msg::kEventObjectReached, 7);
  ASSERT_EQ(last_.task, msg::kTaskPregrasp);
  EXPECT_EQ(last_.parameters.object_handle, 7);
  succeed_with(msg::kEventObjectPregrasped, 8);  // a new handle after the touch
  ASSERT_EQ(last_.task, msg::kTaskGrasp);
  EXPECT_EQ(last_.parameters.object_handle, 8);
  abort(msg::kEventObjectGraspLost);
  ASSERT_EQ(last_.task, msg::kTaskSearchObject);
  EXPECT_EQ(last_.parameters.object_handle, 0) << "the map may give it a new handle";
}

TEST_F(PlannerTest, IgnoresAnObjectInASingleImage) {
  find_line();
  for (int i = 0; i < 10; ++i) {
    see(msg::kColourGreen, msg::kBlobObject, 1.0);
    step();
    objects_ = {};
    step();
  }
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, IgnoresAnObjectOnItsZoneAfterADropOfItsColour) {
  config_.sequence = {msg::kColourGreen, msg::kColourGreen};
  find_line();
  fetch(msg::kColourGreen);
  carry();
  drop(msg::kColourGreen);
  map_.object_count = 1;
  map_.objects[0].x_m = pose_.x_m + 1.0;
  map_.objects[0].y_m = pose_.y_m;
  see_line(true);
  turn();
  see(msg::kColourGreen, msg::kBlobObject, 1.1);
  face(0.0);
  steps(20);
  EXPECT_EQ(memory_.state, kFollowLine);
  map_.objects[0].x_m += 2.0;  // an object elsewhere is retrieved
  steps(4);
  EXPECT_EQ(memory_.state, kTrackObject);
}

}  // namespace
}  // namespace constrictor
