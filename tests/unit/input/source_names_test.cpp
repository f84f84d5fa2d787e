// The arbiter's memory of its sources: repeated requests, writers, deaths, detached sources, and the number of names.
#include <gtest/gtest.h>

#include <string>

#include "input/arbiter.hpp"
#include "requests.hpp"

namespace constrictor {
namespace {

TEST(Arbiter, AClientCannotTakeThePlannersNameEvenBeforeThePlannersFirstRequest) {
  ArbiterState state;
  Arbiter arbiter(state);
  const auto impostor = arbiter.decide_client(request("planner", kExternal, msg::kRequestTake, 1), writer(1));
  EXPECT_EQ(impostor.kind, Decision::kRefused);
  EXPECT_NE(state.refusal.find("reserved for the built-in planner"), std::string::npos) << state.refusal;
  EXPECT_NE(arbiter.decide_planner(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 1, 1)).kind,
            Decision::kRefused);
}

class SourceNames : public ::testing::Test {
 protected:
  ArbiterState state_;
  Arbiter arbiter_{state_};
  Decision::Kind kind(const msg::Request& r) { return arbiter_.decide_client(r).kind; }
  msg::Request detached(const std::string& name, std::uint64_t number) {
    auto r = request(name, kOperator, msg::kRequestTake, number);
    r.detached = true;
    return r;
  }
};

TEST_F(SourceNames, ARepeatedRequestIsDecidedOnceAndAnsweredAsBefore) {
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTask, 1, 1)), Decision::kForward);
  EXPECT_EQ(kind(request("b", kExternal, msg::kRequestTake, 4)), Decision::kRefused);
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestRelease, 5)), Decision::kCancelAll);
  EXPECT_EQ(state_.refused, 1u);
  const auto again = arbiter_.decide_client(request("a", kExternal, msg::kRequestTask, 1, 1));
  EXPECT_EQ(again.kind, Decision::kRepeated);
  EXPECT_TRUE(again.granted);
  const auto refused = arbiter_.decide_client(request("b", kExternal, msg::kRequestTake, 4));
  EXPECT_EQ(refused.kind, Decision::kRepeated);
  EXPECT_FALSE(refused.granted);
  EXPECT_TRUE(state_.holder.empty());
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTake, 3)),
            Decision::kRefused);  // an older number that never arrived
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTake, 70)), Decision::kNothing);
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTake, 5)),
            Decision::kRefused);  // too old: its decision is forgotten
}

TEST_F(SourceNames, AProcessWithTheNameOfADeadOneCountsFromTheBeginning) {
  arbiter_.decide_client(request("p", kExternal, msg::kRequestTask, 57, 9), writer(1));
  EXPECT_FALSE(arbiter_.has_another_writer("p", writer(1)));
  EXPECT_TRUE(arbiter_.has_another_writer("p", writer(2)));
  EXPECT_EQ(arbiter_.on_death("p").kind, Decision::kCancelAll);
  const auto first = arbiter_.decide_client(request("p", kExternal, msg::kRequestTask, 1, 1), writer(2));
  EXPECT_EQ(first.kind, Decision::kForward);
  EXPECT_FALSE(arbiter_.has_another_writer("p", writer(2)));
}

TEST_F(SourceNames, ADeadDetachedSourceIsForgottenWhenItLosesAuthority) {
  for (int i = 0; i < 200; ++i) {
    const std::string name = "script" + std::to_string(i);
    ASSERT_EQ(kind(detached(name, 1)), i == 0 ? Decision::kNothing : Decision::kCancelAll) << state_.refusal;
    EXPECT_EQ(arbiter_.on_death(name).kind, Decision::kNothing);
    EXPECT_EQ(state_.holder, name);
    EXPECT_EQ(state_.sources.size(), 1u);
  }
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestRelease, 1)), Decision::kCancelAll);
  EXPECT_EQ(state_.sources.size(), 1u);  // the pilot
  EXPECT_EQ(kind(detached("late", 1)), Decision::kNothing);
  EXPECT_EQ(kind(request("late", kOperator, msg::kRequestRelease, 2)), Decision::kCancelAll);
  EXPECT_EQ(arbiter_.on_death("late").kind, Decision::kNothing);
  EXPECT_FALSE(state_.sources.contains("late"));
}

TEST_F(SourceNames, TheSuccessorOfADetachedHolderContinuesItsGoalsAndNotItsRequests) {
  auto start = detached("script", 900);
  start.kind = msg::kRequestTask;
  start.goal_id = 0;
  const auto goal = arbiter_.decide_client(start, writer(1)).goal_id;
  arbiter_.on_death("script");
  EXPECT_TRUE(arbiter_.living().empty());
  start.header.sequence_number = 1;
  EXPECT_EQ(arbiter_.decide_client(start, writer(2)).goal_id, goal + 1);
  EXPECT_EQ(arbiter_.living().size(), 1u);
  EXPECT_EQ(kind(request("script", kOperator, msg::kRequestRelease, 2)), Decision::kCancelAll);
}

TEST_F(SourceNames, DeadNamesNeedNoMemory) {
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "n" + std::to_string(i);
    kind(request(name, kExternal, msg::kRequestTake, 1));
    arbiter_.on_death(name);
  }
  EXPECT_TRUE(state_.sources.empty());
  for (int i = 0; i < 1000; ++i) kind(request("n" + std::to_string(i), kExternal, msg::kRequestRelease, 1));
  EXPECT_LE(state_.sources.size(), 64u);
  EXPECT_EQ(kind(request("last", kOperator, msg::kRequestEmergencyStop, 1)), Decision::kCancelAll);
}

TEST_F(SourceNames, ManyExternalPlannersLeaveRoomForOperators) {
  for (int i = 0; i < 100; ++i) kind(request("n" + std::to_string(i), kExternal, msg::kRequestTake, 1));
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 1)), Decision::kCancelAll) << state_.refusal;
  EXPECT_EQ(kind(request("another", kOperator, msg::kRequestEmergencyStop, 1)), Decision::kCancelAll);
  EXPECT_EQ(kind(request("another", kOperator, msg::kRequestClearStop, 2)), Decision::kNothing) << state_.refusal;
}

TEST_F(SourceNames, ACancelThatTakesAuthorityEndsTheRunningTask) {
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTask, 1, 1)), Decision::kForward);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestRelease, 2)), Decision::kCancelAll);
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTask, 1, 1)), Decision::kForward);
  auto cancel = request("pilot", kOperator, msg::kRequestTask, 3, 1);
  cancel.command = msg::kCommandCancel;
  EXPECT_EQ(kind(cancel), Decision::kCancelAll);  // the planner's task must end, not the pilot's old goal
  EXPECT_EQ(state_.holder, "pilot");
}

}  // namespace
}  // namespace constrictor
