// Requests that navigation or `input` refuses: what the planner waits for, what it does instead, and when it gives up.
#include <gtest/gtest.h>

#include <set>

#include "component/task_refusal.hpp"
#include "constrictor/text.hpp"
#include "scripted_planner.hpp"

namespace constrictor {
namespace {

using enum MissionState;

const std::string kNoJoints = std::string(kNotReady) + "the joints are missing";
const std::string kLacks = "this robot's navigation lacks the task";

/// A navigation that refuses what `refuses` says, with this reason, one tick after the request.
class RefusalTest : public PlannerTest {
 protected:
  struct Asked {
    double at_s;
    std::uint8_t task, direction;
  };

  template <class Refuses>
  void run(double seconds, const std::string& reason, Refuses refuses) {
    with_status_ = false;
    const double until_s = time_s_ + seconds;
    while (time_s_ < until_s && memory_.state != kFailed && memory_.state != kDone) {
      std::vector<msg::TaskEvent> answer;
      if (open_) {
        const bool refused = refuses(last_);
        answer.push_back(event(msg::kEventNone, refused ? msg::kGoalRefused : msg::kGoalRunning));
        if (refused) set_text(answer.back().detail, reason);
      }
      const std::string before = memory_.hindrance;
      const auto wanted = step(answer);
      hindrances_ += memory_.hindrance != before && !memory_.hindrance.empty() ? 1 : 0;
      open_ = wanted && wanted->command == msg::kCommandStart;
      if (open_) asked_.push_back({time_s_, wanted->task, wanted->parameters.direction});
    }
  }
  void refuse_all(double seconds, const std::string& reason) {
    run(seconds, reason, [](const WantedTask&) { return true; });
  }
  void accept_all(double seconds) {
    run(seconds, "", [](const WantedTask&) { return false; });
  }

  std::vector<Asked> asked_;
  int hindrances_ = 0;  ///< how often the planner had something new to say
  bool open_ = false;   ///< the last request is not yet answered
};

TEST_F(RefusalTest, AsksAgainWithGrowingPausesUntilNavigationIsReadyAndCountsNoRecovery) {
  refuse_all(20.0, kNoJoints);
  ASSERT_GE(asked_.size(), 7U);
  // Each pause begins with the answer, one tick after the request.
  const double pauses_s[] = {0.5, 1.0, 2.0, 4.0, 4.0, 4.0};
  for (std::size_t i = 0; i < std::size(pauses_s); ++i)
    EXPECT_NEAR(asked_[i + 1].at_s - asked_[i].at_s, pauses_s[i] + 0.02, 0.021) << i;
  EXPECT_EQ(memory_.recoveries, 0);
  EXPECT_EQ(hindrances_, 1) << "the same hindrance is named once";
  EXPECT_NE(memory_.hindrance.find(kNoJoints), std::string::npos) << memory_.hindrance;
  accept_all(5.0);
  EXPECT_EQ(memory_.hindrance, "");
  asked_.clear();
  see_line(true);
  accept_all(0.3);
  EXPECT_EQ(memory_.state, kFollowLine);
  ASSERT_FALSE(asked_.empty());
  EXPECT_EQ(asked_.front().task, msg::kTaskFollowLine) << "nothing is left of the pauses";
}

TEST_F(RefusalTest, PausesAreParameters) {
  config_.refused_pause_s = 0.1;
  config_.refused_longest_pause_s = 0.3;
  refuse_all(2.0, kNoJoints);
  ASSERT_GE(asked_.size(), 5U);
  const double pauses_s[] = {0.1, 0.2, 0.3, 0.3};
  for (std::size_t i = 0; i < std::size(pauses_s); ++i)
    EXPECT_NEAR(asked_[i + 1].at_s - asked_[i].at_s, pauses_s[i] + 0.02, 0.021) << i;
}

TEST_F(RefusalTest, GivesUpAfterTheStatedTimeAndSaysWhatWasRefusedAndWhy) {
  config_.refused_timeout_s = 30.0;
  refuse_all(100.0, kNoJoints);
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_NEAR(time_s_, 30.0, 0.1);
  EXPECT_EQ(memory_.recoveries, 0);
  EXPECT_NE(memory_.reason.find(kNoJoints), std::string::npos) << memory_.reason;
}

TEST_F(RefusalTest, NeverRepeatsARequestThatIsPointless) {
  refuse_all(60.0, kLacks);
  ASSERT_GE(asked_.size(), 5U);
  EXPECT_LE(asked_.size(), 60U) << "pauses grow";
  for (std::size_t i = 1; i < asked_.size(); ++i) {
    const bool same = asked_[i].task == asked_[i - 1].task && asked_[i].direction == asked_[i - 1].direction;
    EXPECT_FALSE(same) << i << ": task " << int{asked_[i].task};
  }
  EXPECT_LT(asked_[1].at_s - asked_[0].at_s, 0.1) << "something else is tried at once";
  EXPECT_EQ(memory_.recoveries, 0);
  refuse_all(120.0, kLacks);
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_NE(memory_.reason.find(kLacks), std::string::npos) << memory_.reason;
}

TEST_F(RefusalTest, SearchesByTurningWhereNavigationCannotExplore) {
  run(100.0, kLacks, [](const WantedTask& wanted) { return wanted.task == msg::kTaskExplore; });
  EXPECT_EQ(memory_.state, kSearchLineOrObject) << memory_.reason;
  const auto turns =
      std::count_if(asked_.begin(), asked_.end(), [](const Asked& asked) { return asked.task == msg::kTaskRotate; });
  EXPECT_GE(turns, 8) << "of 10 s each";
}

TEST_F(RefusalTest, SearchesFurtherWhileADropIsRefusedAndGivesUpInTheEnd) {
  config_.refused_timeout_s = 30.0;
  find_line();
  fetch(msg::kColourGreen);
  carry();
  see_zone(msg::kColourGreen, 0.8);
  const auto is_drop = [](const WantedTask& wanted) { return wanted.task == msg::kTaskDrop; };
  run(10.0, "no drop zone of this colour was seen yet", is_drop);
  const auto drops =
      std::count_if(asked_.begin(), asked_.end(), [](const Asked& asked) { return asked.task == msg::kTaskDrop; });
  EXPECT_GE(drops, 3);
  EXPECT_LE(drops, 6);
  EXPECT_TRUE(row_of(memory_.state).holding);
  EXPECT_EQ(memory_.recoveries, 0);
  run(40.0, "no drop zone of this colour was seen yet", is_drop);
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_NE(memory_.reason.find("drop was refused"), std::string::npos) << memory_.reason;
}

TEST_F(RefusalTest, AnObjectThatIsAlwaysRefusedIsPutAside) {
  const auto refuses_green = [](const WantedTask& wanted) {
    return wanted.task == msg::kTaskTrackObject && wanted.parameters.object_colour == msg::kColourGreen;
  };
  see(msg::kColourGreen, msg::kBlobObject, 1.0);
  for (int i = 0; i < 20 && memory_.aside == 0; ++i) {
    run(8.0, "the object is too large", refuses_green);
    if (memory_.state != kSearchObject) continue;
    succeed(msg::kEventObjectFound);
    open_ = memory_.requested;  // to track the object
  }
  EXPECT_EQ(memory_.object_index, 1) << "red is next";
  EXPECT_EQ(memory_.aside, 1U);
  EXPECT_EQ(memory_.recoveries, 0);
}

// People want to know what is wrong with the object, not how often it was tried.
TEST_F(RefusalTest, AMissionThatGivesUpAnObjectSaysWhyItWasRefused) {
  config_.sequence = {msg::kColourGreen};
  see(msg::kColourGreen, msg::kBlobObject, 1.0);
  for (int i = 0; i < 40 && memory_.state != kFailed; ++i) {
    run(8.0, "the object is too large", [](const WantedTask& wanted) { return wanted.task == msg::kTaskTrackObject; });
    if (memory_.state != kSearchObject) continue;
    succeed(msg::kEventObjectFound);
    open_ = memory_.requested;  // to track the object
  }
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_EQ(memory_.reason,
            "not delivered: green (6 attempts failed, the last in track object: the object is too large)");
}

TEST_F(RefusalTest, ARefusalOfInputIsNoticedAtOnce) {
  find_line();
  // `input` has refused the newest request: navigation keeps its old goal, and no event comes.
  set_text(authority_.refused_source, "planner");
  set_text(authority_.refusal, "more than 3 task commands in a tick");
  see(msg::kColourGreen, msg::kBlobObject, 1.0);
  while (memory_.state != kTrackObject) step();
  authority_.refused_sequence = 7;
  const auto goals = memory_.goals;
  const double from_s = time_s_;
  taken_.assign(3, goals - 1);
  for (int i = 0; i < 100 && memory_.goals == goals; ++i) {
    taken_.assign(3, goals - 1);
    step();
  }
  EXPECT_EQ(memory_.goals, goals + 1);
  EXPECT_EQ(last_.task, msg::kTaskTrackObject);
  EXPECT_NEAR(time_s_ - from_s, config_.refused_pause_s, 0.1);
  EXPECT_EQ(memory_.recoveries, 0);
}

TEST_F(RefusalTest, AnObjectThatIsLostDuringAPauseIsSearchedFor) {
  find_line();
  fetch(msg::kColourGreen);
  see_line(true);
  steps(4);
  ASSERT_EQ(memory_.state, kTransport);
  refuse_all(0.1, kNoJoints);
  msg::TaskEvent refusal = event(msg::kEventNone, msg::kGoalRefused);
  set_text(refusal.detail, kNoJoints);
  step({refusal});
  ASSERT_EQ(memory_.state, kTransport);
  step({event(msg::kEventObjectGraspLost)});
  EXPECT_EQ(memory_.state, kSearchObject);
}

TEST_F(RefusalTest, ALongSuspensionEndsTheMissionAfterTheStatedTimeAndNamesTheHolder) {
  config_.suspended_timeout_s = 40.0;
  find_line();
  const double from_s = time_s_;
  authority_.level = msg::kAuthorityOperator;
  set_text(authority_.source, "teleop.desk.42");
  for (int i = 0; i < 1900; ++i) ASSERT_FALSE(step());
  EXPECT_NE(memory_.state, kFailed);
  EXPECT_NE(memory_.hindrance.find("teleop.desk.42"), std::string::npos) << memory_.hindrance;
  for (int i = 0; i < 200 && memory_.state != kFailed; ++i) ASSERT_FALSE(step()) << "it commands nothing";
  EXPECT_EQ(memory_.state, kFailed);
  EXPECT_NEAR(time_s_ - from_s, 40.0, 0.1);
  EXPECT_NE(memory_.reason.find("teleop.desk.42 has authority"), std::string::npos) << memory_.reason;
}

}  // namespace
}  // namespace constrictor
