// Suspensions of the mission while another source has authority, or no percepts arrive.
#include <gtest/gtest.h>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

TEST_F(PlannerTest, AnOperatorSuspendsTheMissionWhichContinuesWithASearch) {
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
  EXPECT_EQ(memory_.state, kSearchLine);  // with the object
  carry();
}

// The last event of the drop crosses the change of authority.
TEST_F(PlannerTest, ADropByThePlannerCountsAsDeliveredEvenIfAuthorityChangesAtThatMoment) {
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see_zone(msg::kColourGreen, 0.8);
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
  EXPECT_EQ(memory_.state, kInspect) << "nothing shows yet where the object stands";
  map_dropped(msg::kColourGreen, 0.1);
  step();
  EXPECT_EQ(memory_.object_index, 1) << "red is next";
}

TEST_F(PlannerTest, AfterAnEmergencyStopWaitsUntilASourceReleasesAuthority) {
  find_line();
  authority_.level = msg::kAuthorityEmergencyStop;
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

TEST_F(PlannerTest, WithoutPerceptsTheRobotStandsAndTheMissionGoesOnWhenTheyAreBack) {
  find_line();
  images_ = false;
  steps(140);  // 2.8 s
  EXPECT_TRUE(memory_.hindrance.empty());
  std::optional<WantedTask> wanted;
  for (int i = 0; i < 20 && !wanted; ++i) wanted = step();
  ASSERT_TRUE(wanted);
  EXPECT_EQ(wanted->command, msg::kCommandCancel);
  EXPECT_EQ(wanted->goal_id, memory_.goals) << "of the task that was going on";
  EXPECT_NE(memory_.hindrance.find("no percepts"), std::string::npos) << memory_.hindrance;
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(step()) << "a blind robot makes no move";
  images_ = true;
  see_nothing();
  ASSERT_TRUE(step());
  EXPECT_EQ(memory_.state, kSearchLineOrObject);
  EXPECT_TRUE(memory_.hindrance.empty());
  EXPECT_EQ(memory_.recoveries, 0);
  find_line();
}

TEST_F(PlannerTest, WithoutPerceptsForTooLongTheMissionFailsWithTheReason) {
  find_line();
  images_ = false;
  while (memory_.state != kFailed && time_s_ < 60) step();
  EXPECT_NEAR(time_s_, config_.blind_timeout_s, 1.0);
  EXPECT_EQ(memory_.reason, "no percepts for 30 s: are the camera and perception running?");
  EXPECT_EQ(last_.command, msg::kCommandCancel);
}

TEST_F(PlannerTest, AGraspIsNotBrokenOffForLackOfPercepts) {
  find_line();
  drive(4.0);
  see(msg::kColourGreen, msg::kBlobObject, 1.2);
  steps(4);
  succeed(msg::kEventObjectReached);
  succeed(msg::kEventObjectPregrasped);
  ASSERT_EQ(memory_.state, kGrasp);
  images_ = false;
  for (int i = 0; i < 500; ++i) ASSERT_FALSE(step());
  status_.carrying = true;
  EXPECT_FALSE(step({event(msg::kEventObjectGrasped, msg::kGoalSucceeded)}));
  EXPECT_EQ(memory_.state, kSearchLine);
  EXPECT_FALSE(step()) << "it waits with the object in its body";
  images_ = true;
  EXPECT_TRUE(step());
}

}  // namespace
}  // namespace constrictor
