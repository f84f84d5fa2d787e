// Recoveries from lost lines, objects and grasps, and from refused goals.
#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

TEST_F(PlannerTest, RecoversALostLineByExploringAndTurning) {
  find_line();
  see_line(false);
  abort(msg::kEventLineLost);
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  EXPECT_EQ(memory_.recoveries, 1);
  std::set<std::pair<int, int>> tried;
  for (int i = 0; i < 6000; ++i) {
    if (const auto wanted = step()) tried.insert({wanted->task, wanted->parameters.direction});
  }
  EXPECT_TRUE(tried.contains({msg::kTaskExplore, msg::kDirectionForwards}));
  EXPECT_TRUE(tried.contains({msg::kTaskExplore, msg::kDirectionBackwards}));
  EXPECT_TRUE(tried.contains({msg::kTaskRotate, msg::kDirectionLeft}));
  EXPECT_TRUE(tried.contains({msg::kTaskRotate, msg::kDirectionRight}));
  see_line(true);
  steps(4);
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, SearchesALostLineAtItsLastKnownPlace) {
  find_line();
  drive(2.0);
  see_line(false);
  pose_.y_m -= 0.8;  // the robot is to the right of the line and faces away from it
  face(-1.0);
  abort(msg::kEventLineLost);
  EXPECT_EQ(last_.task, msg::kTaskRotate);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionLeft);
  face(0.9);
  step();
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionForwards);
}

TEST_F(PlannerTest, SearchesTheObjectAtTheEndOfTheLine) {
  find_line();
  succeed(msg::kEventEndOfLine);
  EXPECT_EQ(last_.task, msg::kTaskSearchObject);
  EXPECT_EQ(last_.parameters.object_colour, msg::kColourGreen);
  step({event(msg::kEventObjectFound)});
  EXPECT_EQ(memory_.state, kSearchObject);  // until the search has confirmed the object
  succeed(msg::kEventNone);
  EXPECT_EQ(last_.task, msg::kTaskTrackObject);
  EXPECT_EQ(memory_.recoveries, 0);
}

TEST_F(PlannerTest, TurnsRoundAtAnEndOfTheLineAmongZones) {
  find_line();
  drive(2.0);
  see_zone(msg::kColourRed, 1.5);
  step();
  succeed(msg::kEventEndOfLine);
  EXPECT_EQ(memory_.state, kTurnRound);
  see_nothing();
  steps(600);
  see_line(true);  // the robot still faces the wrong end of the line
  steps(10);
  EXPECT_EQ(memory_.state, kTurnRound);
  turn();
  EXPECT_EQ(memory_.state, kFollowLine);
  EXPECT_LT(std::cos(pose_.yaw_rad), -0.5);
}

TEST_F(PlannerTest, RecoversALostObjectPregraspAndGrasp) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  status_.carrying = false;
  step({event(msg::kEventObjectGraspLost)});
  EXPECT_EQ(memory_.state, kSearchObject);
  succeed(msg::kEventObjectFound);
  EXPECT_EQ(memory_.state, kTrackObject);
  abort(msg::kEventObjectLost);
  EXPECT_EQ(memory_.state, kApproachAnew) << "not the same again";
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionBackwards);
  steps(310);  // approach_anew_s is 6 s
  EXPECT_EQ(memory_.state, kSearchObject);
  succeed(msg::kEventObjectFound);
  succeed(msg::kEventObjectReached);
  EXPECT_EQ(memory_.state, kPregrasp);
  abort(msg::kEventObjectPregraspLost);
  EXPECT_EQ(memory_.state, kApproachAnew);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionLeft);
  succeed(msg::kEventNone);
  EXPECT_EQ(memory_.state, kSearchObject);
  succeed(msg::kEventObjectFound);
  succeed(msg::kEventObjectReached);
  succeed(msg::kEventObjectPregrasped);
  EXPECT_EQ(memory_.state, kGrasp);
  abort(msg::kEventObjectGraspLost);
  EXPECT_EQ(memory_.state, kApproachAnew);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionRight);
  EXPECT_EQ(memory_.recoveries, 4);
}

TEST_F(PlannerTest, ALostGraspCountsAlsoIfItCrossesANewRequest) {
  find_line();
  fetch(msg::kColourGreen);
  see_line(true);
  steps(3);  // the planner requests follow_line
  EXPECT_EQ(memory_.state, kTransport);
  auto crossing = event(msg::kEventObjectGraspLost);
  --crossing.goal_id;
  step({crossing});
  EXPECT_EQ(memory_.state, kSearchObject);
}

// Beside the last piece of a line, the turning head sees only the line behind it.
TEST_F(PlannerTest, ALineThatIsOnlySeenTheWrongWayIsFollowedAndTheRobotTurnsOnIt) {
  config_.sequence.clear();
  find_line();
  drive(4.0);
  face(std::numbers::pi);
  abort(msg::kEventLineLost);
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  see_line(true);
  steps(700);
  EXPECT_EQ(memory_.state, kSearchLineOrObject) << "the search turns the robot first";
  steps(60);  // any_way_s is 15 s
  EXPECT_EQ(memory_.state, kFollowLine);
  step({event(msg::kEventEndOfLine)});
  EXPECT_EQ(memory_.state, kTurnRound) << "the wrong end of the line is not the end of the mission";
  turn();
  EXPECT_EQ(memory_.state, kFollowLine);
  steps(400);
  EXPECT_EQ(memory_.state, kFollowLine) << "now it leads the right way";
  step({event(msg::kEventEndOfLine)});
  EXPECT_EQ(memory_.state, kDone);
}

TEST_F(PlannerTest, TheEndFromWhichTheRobotCameDoesNotEndAMissionWithoutObjects) {
  config_.sequence.clear();
  find_line();
  drive(4.0);
  face(std::numbers::pi);
  drive(3.5);  // back, whatever the reason
  EXPECT_EQ(memory_.state, kFollowLine);
  see_line(false);
  step({event(msg::kEventEndOfLine)});
  EXPECT_EQ(memory_.state, kTurnRound);
}

// The line stays in view while a wall between the arms of the U holds the robot.
TEST_F(PlannerTest, ARobotThatIsCaughtWhileItFollowsTheLineWithAnObjectIsLedAway) {
  config_.standstill_s = 15.0;
  find_line();
  fetch(msg::kColourGreen);
  carry();
  const int recoveries = memory_.recoveries;
  for (int i = 0; i < 800 && memory_.state == kTransport; ++i) step();  // standstill_s is 15 s
  EXPECT_EQ(memory_.state, kSearchLine);
  EXPECT_EQ(memory_.recoveries, recoveries + 1);
  step();
  EXPECT_EQ(last_.task, msg::kTaskExplore);
  EXPECT_EQ(last_.parameters.direction, msg::kDirectionBackwards);
  steps(50);
  EXPECT_EQ(memory_.state, kSearchLine) << "to see the line frees nobody";
  std::vector<std::uint8_t> tasks;
  for (int i = 0; i < 12'000 && memory_.state == kSearchLine; ++i) {
    if (step()) tasks.push_back(last_.task);
  }
  EXPECT_EQ(memory_.state, kTransport);
  ASSERT_GE(tasks.size(), 3u);
  EXPECT_EQ(tasks[0], msg::kTaskExplore);
  EXPECT_EQ(tasks[1], msg::kTaskRotate);
  EXPECT_EQ(tasks[2], msg::kTaskExplore);
}

TEST_F(PlannerTest, NavigationsReportOfAHeldObjectOverridesTheStateAfterAWhile) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  status_.carrying = false;
  steps(50);
  EXPECT_EQ(memory_.state, kTransport);
  steps(60);
  EXPECT_EQ(memory_.state, kSearchObject);
  status_.carrying = true;
  steps(120);
  EXPECT_NE(memory_.state, kSearchObject);
  EXPECT_TRUE(row_of(memory_.state).holding);
}

TEST_F(PlannerTest, IgnoresEventsOfOtherGoals) {
  find_line();
  for (const std::int64_t off : {-1, 1, 1000}) {
    msg::TaskEvent other = event(msg::kEventLineLost, msg::kGoalAborted);
    other.goal_id += static_cast<std::uint64_t>(off);
    step({other});
    EXPECT_EQ(memory_.state, kFollowLine);
  }
}

TEST_F(PlannerTest, RepeatsARequestThatNavigationDoesNotTake) {
  find_line();
  with_status_ = false;
  status_ = {};
  steps(10);
  with_status_ = true;
  taken_.assign(3, 0);
  const auto goals = memory_.goals;
  for (int i = 0; i < 150 && memory_.goals == goals; ++i) {
    taken_.assign(3, 0);
    step();
  }
  EXPECT_EQ(memory_.goals, goals + 1);
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, ARefusedGoalLeadsToAnotherStateAndIsNoRecovery) {
  find_line();
  see(msg::kColourGreen, msg::kBlobObject, 1.0);
  steps(4);
  see_nothing();
  step({event(msg::kEventNone, msg::kGoalRefused)});
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_EQ(memory_.recoveries, 0);
}

TEST_F(PlannerTest, AfterADropFollowsTheLineOnlyTowardsTheObjectsAndWithAStraightBody) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  drop(msg::kColourGreen);
  see_line(true);
  steps(20);
  EXPECT_EQ(memory_.state, kTurnRound);
  const bool left = last_.parameters.direction == msg::kDirectionLeft;
  face(0.0, left ? -1.2 : 1.2);  // the head has the direction, the body not yet
  steps(20);
  EXPECT_EQ(memory_.state, kTurnRound);
  face(left ? 0.3 : -0.3, left ? -0.2 : 0.2);  // both have it, and the body is nearly straight
  steps(4);
  EXPECT_EQ(memory_.state, kFollowLine);
}

TEST_F(PlannerTest, TurnsBackIfTheLineLeadsAwayFromTheZonesWhileCarrying) {
  find_line();
  fetch(msg::kColourGreen);
  face(0.2);
  see_line(true);
  steps(4);
  EXPECT_EQ(memory_.state, kTurnBack);
  EXPECT_EQ(last_.task, msg::kTaskRotate);
  face(2.8);
  steps(4);
  EXPECT_EQ(memory_.state, kTransport);
}

}  // namespace
}  // namespace constrictor
