#include <gtest/gtest.h>

#include <random>
#include <set>

#include "input/arbiter.hpp"

namespace constrictor {
namespace {

msg::Request request(const std::string& source, std::uint8_t level, std::uint8_t kind, std::uint64_t sequence, std::uint64_t goal = 1) {
  msg::Request r{};
  std::copy(source.begin(), source.end(), r.source);
  r.level = level;
  r.kind = kind;
  r.header.sequence_number = sequence;
  r.goal_id = goal;
  r.task = msg::kTaskFollowLine;
  return r;
}

class ArbiterTest : public ::testing::Test {
 protected:
  ArbiterState state_;
  Arbiter arbiter_{state_};
  Ruling::Kind decide(const msg::Request& r) { return arbiter_.decide(r).kind; }
};

TEST_F(ArbiterTest, BuiltInPlannerTakesAuthorityByItsFirstTask) {
  EXPECT_EQ(decide(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 1)), Ruling::kForward);
  EXPECT_EQ(state_.holder, "planner");
}

TEST_F(ArbiterTest, AHigherLevelTakesOverAndALowerOneIsRefusedUntilRelease) {
  decide(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 1));
  EXPECT_EQ(decide(request("pilot", msg::kAuthorityOperator, msg::kRequestTask, 1)), Ruling::kForward);
  EXPECT_EQ(decide(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 2)), Ruling::kRefused);
  EXPECT_NE(state_.refusal.find("pilot"), std::string::npos);
  EXPECT_EQ(decide(request("pilot", msg::kAuthorityOperator, msg::kRequestRelease, 2)), Ruling::kCancelAll);
  EXPECT_EQ(decide(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 3)), Ruling::kForward);
}

TEST_F(ArbiterTest, ASecondSourceOfTheSameLevelIsRefused) {
  decide(request("a", msg::kAuthorityExternal, msg::kRequestTask, 1));
  EXPECT_EQ(decide(request("b", msg::kAuthorityExternal, msg::kRequestTask, 1)), Ruling::kRefused);
}

TEST_F(ArbiterTest, EmergencyStopLatchesOverEverybodyAndClearingStartsNoMotion) {
  decide(request("pilot", msg::kAuthorityOperator, msg::kRequestTask, 1));
  EXPECT_EQ(decide(request("planner", msg::kAuthorityPlanner, msg::kRequestEmergencyStop, 1)), Ruling::kCancelAll);
  EXPECT_EQ(decide(request("pilot", msg::kAuthorityOperator, msg::kRequestTask, 2)), Ruling::kRefused);
  EXPECT_EQ(decide(request("other", msg::kAuthorityPlanner, msg::kRequestClearStop, 1)), Ruling::kRefused);
  EXPECT_EQ(decide(request("pilot", msg::kAuthorityOperator, msg::kRequestClearStop, 3)), Ruling::kNothing);
  EXPECT_EQ(state_.level, msg::kAuthorityNone);
}

TEST_F(ArbiterTest, RepeatedOrOlderSequenceNumbersAreRefused) {
  decide(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 5));
  EXPECT_EQ(decide(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 5)), Ruling::kRefused);
  EXPECT_EQ(decide(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 4)), Ruling::kRefused);
}

TEST_F(ArbiterTest, DeathOfTheHolderLeavesAuthorityWithNobody) {
  decide(request("pilot", msg::kAuthorityOperator, msg::kRequestTask, 1));
  EXPECT_EQ(arbiter_.on_death("planner").kind, Ruling::kNothing);
  EXPECT_EQ(arbiter_.on_death("pilot").kind, Ruling::kCancelAll);
  EXPECT_TRUE(state_.holder.empty());
}

TEST_F(ArbiterTest, GoalIdsOfDifferentSourcesNeverCollide) {
  std::set<std::uint64_t> ids;
  std::uint64_t sequence = 0;
  for (const std::string source : {"a", "b", "c"}) {
    for (std::uint8_t level = msg::kAuthorityExternal; level <= msg::kAuthorityOperator; ++level) {
      for (std::uint64_t goal = 1; goal <= 3; ++goal) {
        auto r = request(source, level, msg::kRequestTake, ++sequence, goal);
        decide(r);
        EXPECT_TRUE(ids.insert(arbiter_.goal_id(r)).second);
      }
    }
  }
}

// Independent statement of the rule: after any sequence of requests, a forwarded task came from the highest level among those
// that asked since it became free, and never while stopped.
TEST_F(ArbiterTest, RandomRequestsNeverForwardPastTheHolderOrAStop) {
  std::mt19937 random(7);
  const std::vector<std::pair<std::string, std::uint8_t>> sources = {{"planner", 1}, {"x", 2}, {"y", 2}, {"pilot", 3}};
  std::uint64_t sequence = 0;
  for (int i = 0; i < 20000; ++i) {
    const auto& [name, level] = sources[random() % sources.size()];
    const auto kind = static_cast<std::uint8_t>(random() % 5);
    const std::uint8_t level_before = state_.level;
    const std::string holder_before = state_.holder;
    const bool stopped_before = state_.stopped;
    if (decide(request(name, level, kind, ++sequence)) == Ruling::kForward) {
      EXPECT_FALSE(stopped_before);
      EXPECT_TRUE(holder_before == name || level > level_before);
      EXPECT_EQ(state_.holder, name);
    }
  }
}

}  // namespace
}  // namespace constrictor
