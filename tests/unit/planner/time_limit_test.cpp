// The mission and each of its states always end: because of limits of time and of recoveries, even with random events.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

TEST_F(PlannerTest, FailsWithAReasonAndCancelsAfterTooManyRecoveries) {
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

TEST_F(PlannerTest, EveryStateEndsByItselfWithoutPerceptsAndEvents) {
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

TEST_F(PlannerTest, TheMissionHasATimeLimit) {
  config_.mission_timeout_s = 20.0;
  steps(1002);
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_NE(memory_.reason.find("time limit of the mission"), std::string::npos) << memory_.reason;
  EXPECT_NE(memory_.reason.find("; it has not delivered green; red"), std::string::npos) << memory_.reason;
}

// Within the longest time limit, the planner requests another task or the mission has ended.
TEST_F(PlannerTest, RandomEventsNeverStopTheMissionSilently) {
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
        see(static_cast<std::uint8_t>(random() % 4), static_cast<std::uint8_t>(random() % 3),
            0.1 * static_cast<double>(random() % 30));
      }
      if (random() % 100 == 0) face(0.01 * static_cast<double>(random() % 628));
      if (random() % 300 == 0) status_.carrying = !status_.carrying;
      pose_.x_m += 0.01 * std::cos(pose_.yaw_rad);
      std::vector<msg::TaskEvent> events;
      if (random() % 200 == 0) {
        events.push_back(
            event(static_cast<std::uint8_t>(random() % msg::kEventCount), static_cast<std::uint8_t>(random() % 7)));
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
