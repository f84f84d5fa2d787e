// The arbiter: which requests take authority, and which are refused.
#include "input/arbiter.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "requests.hpp"

namespace constrictor {
namespace {

class ArbiterTest : public ::testing::Test {
 protected:
  ArbiterState state_;
  Arbiter arbiter_{state_};
  Decision decide(const msg::Request& r) {
    return r.level == kPlanner ? arbiter_.decide_planner(r) : arbiter_.decide_client(r);
  }
  Decision::Kind kind(const msg::Request& r) { return decide(r).kind; }
};

TEST_F(ArbiterTest, TheBuiltInPlannerTakesAuthorityWithItsFirstTask) {
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 1)), Decision::kForward);
  EXPECT_EQ(state_.holder, "planner");
}

TEST_F(ArbiterTest, AHigherLevelTakesAuthorityAndALowerOneIsRefusedUntilRelease) {
  decide(request("planner", kPlanner, msg::kRequestTask, 1, 1));
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTask, 1)), Decision::kForward);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 2, 2)), Decision::kRefused);
  EXPECT_NE(state_.refusal.find("pilot"), std::string::npos);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestRelease, 2)), Decision::kCancelAll);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 3, 3)), Decision::kForward);
}

TEST_F(ArbiterTest, TakingAuthorityCancelsTheTaskOfTheFormerHolder) {
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTake, 1)), Decision::kNothing);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 1)), Decision::kCancelAll);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 2)), Decision::kNothing);
}

TEST_F(ArbiterTest, ASecondSourceOfTheSameLevelIsRefused) {
  decide(request("a", kExternal, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("b", kExternal, msg::kRequestTask, 1)), Decision::kRefused);
}

TEST_F(ArbiterTest, RefusesAReleaseFromASourceWithoutAuthority) {
  decide(request("a", kExternal, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("b", kExternal, msg::kRequestRelease, 1)), Decision::kRefused);
  EXPECT_EQ(state_.holder, "a");
}

TEST_F(ArbiterTest, AnEmergencyStopIsLatchedForAllAndClearingItStartsNoMotion) {
  decide(request("pilot", kOperator, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestEmergencyStop, 1)), Decision::kCancelAll);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTask, 2, 2)), Decision::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestClearStop, 1)), Decision::kRefused);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestClearStop, 3)), Decision::kNothing);
  EXPECT_EQ(state_.level, msg::kAuthorityNone);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestClearStop, 4)),
            Decision::kRefused);  // no stop is latched any more
}

TEST_F(ArbiterTest, RefusesOlderSequenceNumbersAndGoalsAndIgnoresARepeatedNumber) {
  decide(request("planner", kPlanner, msg::kRequestTask, 5, 3));
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 5, 4)), Decision::kRepeated);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 4, 4)), Decision::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 6, 3)), Decision::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 7, std::uint64_t{1} << 32)), Decision::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 8, 4)), Decision::kForward);
}

TEST_F(ArbiterTest, RefusesUnknownTasksCommandsKindsAndLevels) {
  auto r = request("x", kExternal, msg::kRequestTask, 1);
  r.task = msg::kTaskNone;
  EXPECT_EQ(kind(r), Decision::kRefused);
  r = request("x", kExternal, msg::kRequestTask, 2);
  r.command = 7;
  EXPECT_EQ(kind(r), Decision::kRefused);
  EXPECT_EQ(kind(request("x", kExternal, 99, 3)), Decision::kRefused);
  EXPECT_EQ(kind(request("", kExternal, msg::kRequestTask, 4)), Decision::kRefused);
  EXPECT_EQ(kind(request("x", msg::kAuthorityEmergencyStop, msg::kRequestTask, 5)), Decision::kRefused);
  EXPECT_EQ(state_.level, msg::kAuthorityNone);
  EXPECT_EQ(state_.refused, 5u);
}

TEST_F(ArbiterTest, EverySourceCanStopEvenWithAnOtherwiseWrongRequest) {
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTask, 9)), Decision::kForward);
  auto r = request("x", 77, msg::kRequestEmergencyStop, 9);  // unknown level, old sequence number
  EXPECT_EQ(kind(r), Decision::kCancelAll);
  EXPECT_TRUE(state_.stopped);
}

TEST_F(ArbiterTest, ADirectMotionTakesAuthorityLikeATask) {
  decide(request("planner", kPlanner, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestMotion, 1)), Decision::kMove);
  EXPECT_EQ(state_.holder, "x");
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestMotion, 2)), Decision::kRefused);
  auto unknown = request("x", kExternal, msg::kRequestMotion, 2);
  unknown.motion = msg::kMotionCount;
  EXPECT_EQ(kind(unknown), Decision::kRefused);
}

TEST_F(ArbiterTest, ADetachedHolderOutlivesItsWriterUntilASourceOfItsLevelTakesOverOrReleases) {
  auto script = request("script", kOperator, msg::kRequestTask, 1);
  script.detached = true;
  decide(script);
  EXPECT_EQ(arbiter_.on_death("script").kind, Decision::kNothing);
  EXPECT_EQ(state_.holder, "script");
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestRelease, 1)), Decision::kRefused);
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTask, 2)), Decision::kRefused);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 1)), Decision::kCancelAll);
  EXPECT_EQ(kind(request("other", kOperator, msg::kRequestTake, 1)), Decision::kRefused);  // the pilot has authority
  decide(request("pilot", kOperator, msg::kRequestRelease, 2));
  script.header.sequence_number = 2;
  script.goal_id = 0;
  EXPECT_EQ(decide(script).goal_id,
            mapped_goal_id(kOperator, 5, 1));  // it was forgotten when it lost authority: it is the fifth source now
  EXPECT_EQ(kind(request("other", kOperator, msg::kRequestRelease, 2)), Decision::kCancelAll);
  EXPECT_EQ(state_.level, msg::kAuthorityNone);
}

TEST_F(ArbiterTest, ARefusalNamesTheSourceAndTheRequest) {
  decide(request("planner", kPlanner, msg::kRequestTask, 1));
  decide(request("x", kExternal, msg::kRequestRelease, 41));
  decide(request("x", kExternal, msg::kRequestTake, 42));
  EXPECT_EQ(state_.refused_source, "x");
  EXPECT_EQ(state_.refused_sequence, 41u);
  EXPECT_EQ(state_.answered_sequence, 42u);
  decide(request("\x1b[2J", kExternal, msg::kRequestTake, 1));
  EXPECT_EQ(state_.refused_source, "?");  // people read it on terminals: no escape sequences
}

TEST_F(ArbiterTest, AClientCannotActAsTheBuiltInPlanner) {
  EXPECT_EQ(arbiter_.decide_client(request("planner", kPlanner, msg::kRequestTask, 1)).kind, Decision::kRefused);
  decide(request("planner", kPlanner, msg::kRequestTask, 1));
  EXPECT_EQ(arbiter_.decide_client(request("planner", kOperator, msg::kRequestTask, 2, 2)).kind, Decision::kRefused);
}

TEST_F(ArbiterTest, DeathOfTheHolderLeavesAuthorityWithNobody) {
  decide(request("pilot", kOperator, msg::kRequestTask, 1));
  EXPECT_EQ(arbiter_.on_death("planner").kind, Decision::kNothing);
  EXPECT_EQ(arbiter_.on_death("pilot").kind, Decision::kCancelAll);
  EXPECT_TRUE(state_.holder.empty());
}

TEST_F(ArbiterTest, ACancelNamesAGoalThatItsSourceStarted) {
  const auto started = decide(request("x", kExternal, msg::kRequestTask, 1, 7)).goal_id;
  auto cancel = request("x", kExternal, msg::kRequestTask, 2, 7);
  cancel.command = msg::kCommandCancel;
  EXPECT_EQ(decide(cancel).goal_id, started);
  cancel.header.sequence_number = 3;
  cancel.goal_id = 8;
  EXPECT_EQ(kind(cancel), Decision::kRefused);
}

TEST_F(ArbiterTest, GoalIdsOfDifferentSourcesNeverCollide) {
  std::set<std::uint64_t> ids;
  std::uint64_t sequence = 0;
  for (std::uint64_t goal = 1; goal <= 50; ++goal) {
    for (const auto& [source, level] : std::vector<std::pair<std::string, std::uint8_t>>{
             {"planner", kPlanner}, {"a", kExternal}, {"b", kExternal}, {"c", kOperator}}) {
      const auto decision = decide(request(source, level, msg::kRequestTask, ++sequence, goal));
      ASSERT_EQ(decision.kind, Decision::kForward);
      EXPECT_TRUE(ids.insert(decision.goal_id).second);
      decide(request(source, level, msg::kRequestRelease, ++sequence));
    }
  }
}

// Independently of the arbiter: a task or motion is granted only if its source has authority or a higher level than the
// holder, and never during an emergency stop. A refused request changes nothing.
TEST_F(ArbiterTest, RandomRequestsNeverBypassTheHolderOrAStop) {
  std::mt19937 random(7);
  const std::vector<std::pair<std::string, std::uint8_t>> sources = {
      {"planner", kPlanner}, {"x", kExternal}, {"y", kExternal}, {"pilot", kOperator}};
  std::uint64_t sequence = 0;
  int forwarded = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto& [name, level] = sources[random() % sources.size()];
    const auto what = static_cast<std::uint8_t>(random() % 6);
    const ArbiterState before = state_;
    ++sequence;
    const auto decision = kind(request(name, level, what, sequence, sequence));
    if (decision == Decision::kForward || decision == Decision::kMove) {
      ++forwarded;
      EXPECT_EQ(what, decision == Decision::kForward ? msg::kRequestTask : msg::kRequestMotion);
      EXPECT_FALSE(before.stopped);
      EXPECT_TRUE(before.holder == name || level > before.level);
      EXPECT_EQ(state_.holder, name);
    } else if (decision == Decision::kRefused) {
      EXPECT_EQ(state_.holder, before.holder);
      EXPECT_EQ(state_.level, before.level);
      EXPECT_EQ(state_.stopped, before.stopped);
      EXPECT_EQ(state_.refused, before.refused + 1);
    }
  }
  EXPECT_GT(forwarded, 100);
}

}  // namespace
}  // namespace constrictor
