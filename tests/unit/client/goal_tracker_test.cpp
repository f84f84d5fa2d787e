// The newest goal, its answer and its end, from messages in the order in which late readers receive them.
#include "client/goal_tracker.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace constrictor {
namespace {

constexpr std::uint64_t kPlanners = (1ULL << 48) + 7;
constexpr std::uint64_t kOurs = (3ULL << 48) + (1ULL << 32) + 1;

msg::Header header(std::int64_t tick, std::uint32_t epoch = 1, std::uint64_t run_id = 5) {
  msg::Header h{};
  h.run_id = run_id;
  h.epoch = epoch;
  h.tick = tick;
  h.sequence_number = static_cast<std::uint64_t>(tick) + 1;
  return h;
}

msg::Authority authority(std::int64_t tick, std::uint64_t goal, std::uint32_t epoch = 1) {
  msg::Authority a{};
  a.header = header(tick, epoch);
  a.goal_id = goal;
  return a;
}

msg::TaskStatus status(std::int64_t tick, std::uint64_t goal, std::uint8_t state) {
  msg::TaskStatus s{};
  s.header = header(tick);
  s.goal_id = goal;
  s.goal_state = state;
  return s;
}

msg::TaskEvent event(std::int64_t tick, std::uint64_t goal, std::uint8_t kind, std::uint8_t state,
                     const char* detail = "", std::uint32_t epoch = 1) {
  msg::TaskEvent e{};
  e.header = header(tick, epoch);
  e.goal_id = goal;
  e.event = kind;
  e.goal_state = state;
  std::snprintf(e.detail, sizeof e.detail, "%s", detail);
  return e;
}

// Just after `task start`: the statuses that the writer keeps begin before the goal.
TEST(GoalTracker, TheNewestGoalIsThatOfTheNewestMessage) {
  GoalTracker watch;
  for (std::int64_t tick = 92; tick < 100; ++tick)
    watch.take(status(tick, tick < 98 ? kPlanners : kOurs, msg::kGoalRunning));
  EXPECT_EQ(watch.newest(), kOurs);
  watch.take(event(97, kPlanners, msg::kEventNone, msg::kGoalPreempted));
  watch.take(authority(50, kPlanners));
  watch.take(authority(97, kOurs));
  watch.take(authority(60, kPlanners));  // arrives late
  EXPECT_EQ(watch.newest(), kOurs);
  EXPECT_FALSE(watch.end(kOurs, true));
  ASSERT_TRUE(watch.end(kPlanners, false));
  EXPECT_EQ(watch.end(kPlanners, false)->state, msg::kGoalPreempted);
}

// `input` has forwarded the goal, but navigation has not started it yet.
TEST(GoalTracker, AuthorityNamesTheNewestGoalBeforeNavigationDoes) {
  GoalTracker watch;
  EXPECT_EQ(watch.newest(), 0u);
  watch.take(status(99, kPlanners, msg::kGoalRunning));
  watch.take(authority(99, kOurs));
  EXPECT_EQ(watch.newest(), kOurs);
  EXPECT_EQ(watch.answer(kOurs), nullptr);
}

TEST(GoalTracker, IgnoresEventsOfOtherGoals) {
  GoalTracker watch;
  watch.take(event(10, kPlanners, msg::kEventEndOfLine, msg::kGoalRunning));
  EXPECT_EQ(watch.event(kOurs, msg::kEventEndOfLine), nullptr);
  EXPECT_EQ(watch.event_after(10, msg::kEventEndOfLine), nullptr);
  watch.take(event(40, kOurs, msg::kEventEndOfLine, msg::kGoalRunning));
  ASSERT_NE(watch.event(kOurs, msg::kEventEndOfLine), nullptr);
  EXPECT_EQ(watch.event(kOurs, msg::kEventEndOfLine)->header.tick, 40);
  ASSERT_NE(watch.event_after(10, msg::kEventEndOfLine), nullptr);
}

TEST(GoalTracker, DistinguishesAcceptedAndRefusedGoals) {
  GoalTracker watch;
  watch.take(event(12, kOurs, msg::kEventNone, msg::kGoalRefused, "explore needs a direction"));
  watch.take(event(11, kPlanners, msg::kEventNone, msg::kGoalRunning, "accepted"));
  ASSERT_NE(watch.answer(kOurs), nullptr);
  EXPECT_EQ(watch.answer(kOurs)->goal_state, msg::kGoalRefused);
  ASSERT_NE(watch.answer(kPlanners), nullptr);
  EXPECT_EQ(watch.answer(kPlanners)->goal_state, msg::kGoalRunning);
  ASSERT_TRUE(watch.end(kOurs, false));
  EXPECT_EQ(watch.end(kOurs, false)->reason, "explore needs a direction");
}

TEST(GoalTracker, AStatusProvesTheEndIfTheEventIsLost) {
  GoalTracker watch;
  watch.take(status(900, kOurs, msg::kGoalSucceeded));
  EXPECT_FALSE(watch.end(kOurs, false)) << "its event may still come";
  ASSERT_TRUE(watch.end(kOurs, true));
  EXPECT_EQ(watch.end(kOurs, true)->state, msg::kGoalSucceeded);
  EXPECT_FALSE(watch.end(kPlanners, true));
}

TEST(GoalTracker, FindsTheNewestGoalByItsShortNumberAndOperatorsFirst) {
  constexpr std::uint64_t kOperator = 3ULL << 48;
  GoalTracker tracker;
  EXPECT_EQ(tracker.find(1), 0u) << "no goal is known";
  tracker.take(event(10, kOperator + (1ULL << 32) + 1, msg::kEventNone, msg::kGoalRunning));
  tracker.take(event(20, kOperator + (2ULL << 32) + 1, msg::kEventNone, msg::kGoalRunning));  // another source
  tracker.take(event(30, (1ULL << 48) + 1, msg::kEventNone, msg::kGoalRunning));              // the planner's
  tracker.take(event(40, (1ULL << 48) + 9, msg::kEventNone, msg::kGoalRunning));
  EXPECT_EQ(tracker.find(1), kOperator + (2ULL << 32) + 1);
  EXPECT_EQ(tracker.find(9), (1ULL << 48) + 9) << "no operator has a goal of this number";
  EXPECT_EQ(tracker.find(2), 0u);
  EXPECT_EQ(tracker.find(kOperator + (1ULL << 32) + 1), kOperator + (1ULL << 32) + 1) << "a whole id is unique";
}

// After a reset goals are numbered from 1 again: the same number is another goal.
TEST(GoalTracker, IgnoresEarlierEpochsAndOtherRuns) {
  GoalTracker watch;
  watch.take(event(500, kOurs, msg::kEventTimeout, msg::kGoalRunning));
  watch.take(authority(3, 0, 2));
  EXPECT_EQ(watch.newest(), 0u);
  EXPECT_EQ(watch.tick(), 3);
  EXPECT_EQ(watch.event(kOurs, msg::kEventTimeout), nullptr);
  watch.take(event(501, kOurs, msg::kEventTimeout, msg::kGoalRunning));  // of epoch 1, delivered late
  EXPECT_EQ(watch.event(kOurs, msg::kEventTimeout), nullptr);
  msg::TaskEvent other = event(10, kOurs, msg::kEventTimeout, msg::kGoalRunning, "", 2);
  other.header.run_id = 6;
  watch.take(other);
  EXPECT_EQ(watch.event(kOurs, msg::kEventTimeout), nullptr);
  watch.take(event(11, kOurs, msg::kEventTimeout, msg::kGoalRunning, "", 2));
  EXPECT_NE(watch.event(kOurs, msg::kEventTimeout), nullptr);
}

}  // namespace
}  // namespace constrictor
