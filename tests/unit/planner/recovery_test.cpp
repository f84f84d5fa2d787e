// What is lost, refused, interrupted or late.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>

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

TEST_F(PlannerTest, ALineLostBesideItIsLookedForWhereItWas) {
  find_line();
  drive(2.0);
  see_line(false);
  pose_.y_m -= 0.8;  // it slid off to the right, and faces away
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
  EXPECT_EQ(memory_.state, kSearchObject);  // until the search has confirmed it
  succeed(msg::kEventNone);
  EXPECT_EQ(last_.task, msg::kTaskTrackObject);
  EXPECT_EQ(memory_.recoveries, 0);
}

TEST_F(PlannerTest, TurnsRoundWhereTheLineEndsAmongZones) {
  find_line();
  drive(2.0);
  see(msg::kColourRed, msg::kBlobZone, 1.5);
  step();
  succeed(msg::kEventEndOfLine);
  EXPECT_EQ(memory_.state, kTurnRound);
  see_nothing();
  steps(600);
  see_line(true);  // still facing the wrong end: not that way
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
  EXPECT_EQ(memory_.state, kSearchObject);
  succeed(msg::kEventObjectFound);
  succeed(msg::kEventObjectReached);
  EXPECT_EQ(memory_.state, kPregrasp);
  abort(msg::kEventObjectPregraspLost);
  EXPECT_EQ(memory_.state, kSearchObject);
  succeed(msg::kEventObjectFound);
  succeed(msg::kEventObjectReached);
  succeed(msg::kEventObjectPregrasped);
  EXPECT_EQ(memory_.state, kGrasp);
  abort(msg::kEventObjectGraspLost);
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_EQ(memory_.recoveries, 4);
}

TEST_F(PlannerTest, ALostGraspCountsEvenIfItCrossesANewRequest) {
  find_line();
  fetch(msg::kColourGreen);
  see_line(true);
  steps(3);  // follow_line is just being asked for
  EXPECT_EQ(memory_.state, kTransport);
  auto crossing = event(msg::kEventObjectGraspLost);
  --crossing.goal_id;
  step({crossing});
  EXPECT_EQ(memory_.state, kSearchObject);
}

TEST_F(PlannerTest, NavigationsWordOnWhatIsHeldCountsAfterAWhile) {
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

TEST_F(PlannerTest, EventsOfAnotherGoalMeanNothing) {
  find_line();
  for (const std::int64_t off : {-1, 1, 1000}) {
    msg::TaskEvent other = event(msg::kEventLineLost, msg::kGoalAborted);
    other.goal_id += static_cast<std::uint64_t>(off);
    step({other});
    EXPECT_EQ(memory_.state, kFollowLine);
  }
}

TEST_F(PlannerTest, ARequestThatIsNeverTakenUpIsMadeAgain) {
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

TEST_F(PlannerTest, ARefusedGoalIsARecovery) {
  find_line();
  see(msg::kColourGreen, msg::kBlobObject, 1.0);
  steps(4);
  see_nothing();
  step({event(msg::kEventNone, msg::kGoalRefused)});
  EXPECT_EQ(memory_.state, kSearchObject);
  EXPECT_EQ(memory_.recoveries, 1);
}

TEST_F(PlannerTest, AfterADropTheLineIsTakenOnlyTowardsTheObjectsAndWhenTheBodyHasFollowedTheHead) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  drop(msg::kColourGreen);
  see_line(true);
  steps(20);
  EXPECT_EQ(memory_.state, kTurnRound);
  const bool left = last_.parameters.direction == msg::kDirectionLeft;
  face(0.0, left ? -1.2 : 1.2);  // the head is there, the body not
  steps(20);
  EXPECT_EQ(memory_.state, kTurnRound);
  face(left ? 0.3 : -0.3, left ? -0.2 : 0.2);  // both, and the body is nearly straight
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

TEST_F(PlannerTest, WhoeverHasAuthorityInterruptsTheMissionAndItGoesOnByLooking) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  authority_.level = msg::kAuthorityOperator;
  see_nothing();
  for (int i = 0; i < 5000; ++i) ASSERT_FALSE(step());
  EXPECT_TRUE(memory_.suspended);
  EXPECT_EQ(memory_.recoveries, 0);
  authority_.level = msg::kAuthorityNone;
  ASSERT_TRUE(step());
  EXPECT_EQ(memory_.state, kSearchLine);  // it still holds the object
  carry();
}

TEST_F(PlannerTest, WhatOthersDropIsDelivered) {
  const auto dropped = [](std::uint8_t level, std::uint8_t colour) {
    msg::TaskEvent event{};
    event.goal_id = (std::uint64_t{level} << 48) + 7;
    event.event = msg::kEventDroppingDone;
    event.goal_state = msg::kGoalRunning;
    event.colour = colour;
    return event;
  };
  find_line();
  authority_.level = msg::kAuthorityExternal;
  step({dropped(msg::kAuthorityExternal, msg::kColourRed)});
  authority_.level = msg::kAuthorityNone;
  step();
  EXPECT_EQ(memory_.object_index, 0);  // green is still to be fetched
  EXPECT_NE(memory_.state, MissionState::kDone);
  authority_.level = msg::kAuthorityOperator;
  step();
  step({dropped(msg::kAuthorityOperator, msg::kColourGreen)});
  authority_.level = msg::kAuthorityNone;
  EXPECT_FALSE(step());
  EXPECT_EQ(memory_.object_index, 2);
  EXPECT_EQ(memory_.state, MissionState::kDone);
}

// Its last word crosses somebody's taking over.
TEST_F(PlannerTest, WhatItsOwnDropPutDownIsDeliveredAlsoIfSomebodyTookOverAtThatMoment) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see(msg::kColourGreen, msg::kBlobZone, 0.8);
  steps(4);
  ASSERT_EQ(last_.task, msg::kTaskDrop);
  status_.carrying = false;
  auto done = event(msg::kEventDroppingDone, msg::kGoalSucceeded);
  done.colour = msg::kColourGreen;
  authority_.level = msg::kAuthorityExternal;
  step({done});
  see_nothing();
  steps(100);
  authority_.level = msg::kAuthorityNone;
  step();
  EXPECT_EQ(memory_.object_index, 1) << "red is next";
}

TEST_F(PlannerTest, AnObjectThatSomebodyElseDroppedIsSkippedInItsTurn) {
  find_line();
  authority_.level = msg::kAuthorityExternal;
  msg::TaskEvent event{};
  event.goal_id = std::uint64_t{msg::kAuthorityExternal} << 48;
  event.event = msg::kEventDroppingDone;
  event.colour = msg::kColourRed;
  step({event});
  authority_.level = msg::kAuthorityNone;
  step();
  find_line();
  fetch(msg::kColourGreen);
  carry();
  drop(msg::kColourGreen);
  EXPECT_EQ(memory_.state, MissionState::kDone);
}

TEST_F(PlannerTest, AClearedEmergencyStopStartsNoMotionUntilSomebodyHandsOver) {
  find_line();
  authority_.level = msg::kAuthorityStop;
  authority_.emergency_stop = true;
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(step());
  authority_.emergency_stop = false;
  authority_.level = msg::kAuthorityNone;
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(step());
  authority_.level = msg::kAuthorityOperator;
  for (int i = 0; i < 100; ++i) ASSERT_FALSE(step());
  authority_.level = msg::kAuthorityNone;
  EXPECT_TRUE(step());
  EXPECT_FALSE(memory_.suspended);
}

TEST_F(PlannerTest, GivesUpWithAReasonAndCancelsWhenNothingHelps) {
  config_.max_recoveries = 3;
  find_line();
  for (int i = 0; i < 50 && memory_.state != kFailed; ++i) {
    see_line(true);
    steps(5);
    abort(msg::kEventLineLost);
  }
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_FALSE(memory_.reason.empty());
  EXPECT_EQ(last_.command, msg::kCommandCancel);
  EXPECT_EQ(last_.goal_id, memory_.goals);
  EXPECT_FALSE(step());
}

TEST_F(PlannerTest, EveryStateEndsByItselfWhenNothingIsEverSeenOrHeard) {
  for (std::size_t i = 0; i < kMissionStates; ++i) {
    const auto state = static_cast<MissionState>(i);
    if (state == kDone || state == kFailed) continue;
    memory_ = {};
    memory_.state = state;
    time_s_ = 0.0;
    taken_.clear();
    with_status_ = false;
    const double longest_s = std::max({config_.task_timeout_s, config_.holding_factor * config_.follow_timeout_s,
                                       config_.holding_factor * config_.search_timeout_s});
    step();
    const auto goals = memory_.goals;
    while (memory_.goals == goals && time_s_ < longest_s + 1.0) step();
    EXPECT_GT(memory_.goals, goals) << name_of(state);
  }
}

TEST_F(PlannerTest, TheMissionsTimeIsBounded) {
  config_.mission_timeout_s = 20.0;
  steps(1002);
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_NE(memory_.reason.find("time"), std::string::npos);
}

// Whatever happens, within the longest time limit a task is wanted again or the mission has ended.
TEST_F(PlannerTest, RandomEventsNeverStrandIt) {
  std::mt19937 random(11);
  std::map<MissionState, int> ends;
  for (int run = 0; run < 12; ++run) {
    memory_ = {};
    taken_.clear();
    time_s_ = 0.0;
    double last_wanted_s = 0.0;
    for (int i = 0; i < 20000; ++i) {
      if (random() % 50 == 0) see_line(random() % 2, 0.01 * static_cast<double>(random() % 300) - 1.5);
      if (random() % 50 == 0) {
        see(static_cast<std::uint8_t>(random() % 4), static_cast<std::uint8_t>(random() % 3), 0.1 * static_cast<double>(random() % 30));
      }
      if (random() % 100 == 0) face(0.01 * static_cast<double>(random() % 628));
      if (random() % 300 == 0) status_.carrying = !status_.carrying;
      pose_.x_m += 0.01 * std::cos(pose_.yaw_rad);
      std::vector<msg::TaskEvent> events;
      if (random() % 200 == 0) {
        events.push_back(event(static_cast<std::uint8_t>(random() % msg::kEventCount), static_cast<std::uint8_t>(random() % 7)));
      }
      if (step(events)) last_wanted_s = time_s_;
      if (memory_.state == kDone || memory_.state == kFailed) break;
      ASSERT_LT(time_s_ - last_wanted_s, config_.holding_factor * config_.follow_timeout_s + 1.0);
    }
    ++ends[memory_.state];
    if (memory_.state == kFailed) {
      EXPECT_FALSE(memory_.reason.empty());
    }
  }
  EXPECT_GT(ends[kDone] + ends[kFailed], 0);
}

}  // namespace
}  // namespace constrictor
