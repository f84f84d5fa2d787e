// The latch for outside requests, and what the arbiter makes of who speaks through which writer, how often, and of who is gone.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <string>

#include "input/arbiter.hpp"
#include "runtime/outside_requests.hpp"
#include "runtime/unanswered_requests.hpp"
#include "requests.hpp"

namespace constrictor {
namespace {

msg::Request motion(const std::string& source, std::uint8_t level, std::uint64_t sequence, std::uint8_t what = msg::kMotionDrive) {
  auto r = request(source, level, msg::kRequestMotion, sequence);
  r.motion = what;
  return r;
}

WriterId writer(std::uint8_t number) {
  WriterId id{};
  id[0] = number;
  return id;
}

/// Those that are to be ruled on.
std::vector<OutsideItem> kept(OutsideRequests& outside) {
  auto items = outside.latch();
  std::erase_if(items, [](const OutsideItem& item) { return !item.refusal.empty(); });
  return items;
}

TEST(OutsideRequests, OrderOfArrivalDoesNotMatter) {
  std::vector<msg::Request> requests;
  for (const std::string source : {"b", "a", "c"}) {
    for (std::uint64_t number = 1; number <= 4; ++number) {
      requests.push_back(request(source, kExternal, msg::kRequestTask, number, number));
    }
  }
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    std::shuffle(requests.begin(), requests.end(), random);
    OutsideRequests outside;
    outside.add_death("b");
    for (const auto& r : requests) outside.add(r);
    const auto items = outside.latch();
    ASSERT_EQ(items.size(), 13u);
    std::string order;
    for (const auto& item : items) order += item.source + (item.died ? "x" : std::to_string(item.request.header.sequence_number));
    EXPECT_EQ(order, "a1a2a3a4b1b2b3b4c1c2c3c4bx");
    EXPECT_TRUE(outside.latch().empty());
  }
}

TEST(OutsideRequests, OfManyMotionsTheNewestAreKeptAndTheStandAtTheirEnd) {
  OutsideRequests outside;
  for (std::uint64_t i = 1; i <= 100; ++i) outside.add(motion("pilot", kOperator, i));
  outside.add(motion("pilot", kOperator, 101, msg::kMotionStand));
  const auto items = outside.latch();
  EXPECT_EQ(items.back().request.header.sequence_number, 101u);
  EXPECT_EQ(items.back().request.motion, msg::kMotionStand);
  EXPECT_EQ(items[items.size() - 2].request.header.sequence_number, 100u);
  std::uint64_t refused = 0;
  std::uint64_t ruled = 0;
  for (const auto& item : items) (item.refusal.empty() ? ruled : refused) += item.times;
  EXPECT_EQ(refused + ruled, 101u) << "none vanishes without being counted";
  EXPECT_EQ(refused, outside.dropped());
  EXPECT_TRUE(std::is_partitioned(items.begin(), items.end(), [](const OutsideItem& i) { return !i.refusal.empty(); }));
}

TEST(OutsideRequests, ATaskAmongManyMotionsOfItsSourceStays) {
  OutsideRequests outside;
  outside.add(request("x", kExternal, msg::kRequestTask, 1));
  for (std::uint64_t i = 2; i <= 40; ++i) outside.add(motion("x", kExternal, i));
  EXPECT_EQ(kept(outside).front().request.kind, msg::kRequestTask);
}

TEST(OutsideRequests, ChattyPlannersLeaveRoomForAnOperatorAndForStandingStill) {
  OutsideRequests outside;
  outside.add(request("pilot", kOperator, msg::kRequestTake, 1));
  for (int source = 0; source < 40; ++source) {
    for (std::uint64_t i = 1; i <= 30; ++i) outside.add(motion("chat" + std::to_string(source), kExternal, i));
    outside.add(request("chat" + std::to_string(source), kExternal, msg::kRequestRelease, 31));
  }
  outside.add(motion("pilot", kOperator, 2));
  outside.add(request("pilot", kOperator, msg::kRequestRelease, 3));
  const auto items = kept(outside);
  EXPECT_LE(items.size(), 64u);
  ASSERT_GE(items.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(items[i].source, "pilot");
    EXPECT_EQ(items[i].request.header.sequence_number, i + 1);
  }
}

TEST(OutsideRequests, AnEmergencyStopFindsRoomInAnyFlood) {
  OutsideRequests outside;
  for (int source = 0; source < 100; ++source) {
    for (std::uint64_t i = 1; i <= 30; ++i) outside.add(request("s" + std::to_string(source), kOperator, msg::kRequestTask, i, i));
  }
  outside.add(request("x", 0, msg::kRequestEmergencyStop, 1));
  outside.add(request("x", 0, msg::kRequestEmergencyStop, 2));
  const auto items = kept(outside);
  EXPECT_EQ(std::count_if(items.begin(), items.end(), [](const auto& i) { return i.request.kind == msg::kRequestEmergencyStop; }), 1);
  EXPECT_EQ(items.back().request.header.sequence_number, 2u);  // of stops of one source the newest, which is the one that waits for an answer
}

TEST(OutsideRequests, WhatIsRepeatedUnderItsNumberCountsOnce) {
  OutsideRequests outside;
  for (int i = 0; i < 50; ++i) outside.add(request("x", kExternal, msg::kRequestTake, 7), writer(1));
  EXPECT_EQ(outside.latch().size(), 1u);
  EXPECT_EQ(outside.dropped(), 0u);
}

TEST(OutsideRequests, TheWordsOfASuccessorComeAfterThoseOfWhoHadTheNameBefore) {
  OutsideRequests outside;
  outside.add(request("x", kExternal, msg::kRequestTake, 57), writer(1));
  outside.add(request("x", kExternal, msg::kRequestTake, 1), writer(2));
  outside.add(request("x", kExternal, msg::kRequestRelease, 2), writer(2));
  const auto items = outside.latch();
  ASSERT_EQ(items.size(), 3u);
  EXPECT_EQ(items[0].request.header.sequence_number, 57u);
  EXPECT_EQ(items[1].request.header.sequence_number, 1u);
  EXPECT_EQ(items[2].request.header.sequence_number, 2u);
}

// The former process of a name died, and the next one spoke, within one tick: it is told of by name alone, and is not the next one.
TEST(OutsideRequests, ADeathTellsOfTheFormerWriterWhereAnotherSpeaksAlready) {
  ArbiterState state;
  Arbiter(state).decide_outside(request("pilot", kOperator, msg::kRequestTake, 1), writer(1));
  OutsideRequests outside;
  outside.watch_writers([](const WriterId& id) { return id == writer(2); });
  outside.add_death("pilot");
  outside.add(request("pilot", kOperator, msg::kRequestTake, 1), writer(2));
  const auto items = outside.latch(Arbiter(state).living());
  ASSERT_EQ(items.size(), 2u);
  EXPECT_FALSE(items[0].died);
  EXPECT_TRUE(items[1].died);
  EXPECT_EQ(items[1].writer, writer(1)) << "known by its writer to be the former one's";
  // Without a successor it is the source's own.
  outside.add_death("pilot");
  outside.watch_writers([](const WriterId&) { return true; });
  const auto last = outside.latch(Arbiter(state).living());
  ASSERT_EQ(last.size(), 1u);
  EXPECT_TRUE(last[0].died);
}

TEST(Arbiter, NobodyOutsideTakesTheBuiltInPlannersNameNotEvenBeforeIt) {
  ArbiterState state;
  Arbiter arbiter(state);
  const auto impostor = arbiter.decide_outside(request("planner", kExternal, msg::kRequestTake, 1), writer(1));
  EXPECT_EQ(impostor.kind, Ruling::kRefused);
  EXPECT_NE(state.refusal.find("built-in planner's"), std::string::npos) << state.refusal;
  EXPECT_NE(arbiter.decide_planner(request("planner", msg::kAuthorityPlanner, msg::kRequestTask, 1, 1)).kind, Ruling::kRefused);
}

// A process that was restarted knows its sources from its checkpoint, and nothing else of them.
TEST(OutsideRequests, AKnownSourceWithoutALivingWriterIsDeadAlsoForWhoNeverHeardIt) {
  ArbiterState state;
  Arbiter(state).decide_outside(request("pilot", kOperator, msg::kRequestTake, 1), writer(1));
  Arbiter(state).decide_outside(request("x", kExternal, msg::kRequestTake, 1), writer(2));
  Arbiter(state).decide_outside(request("unseen", kExternal, msg::kRequestTake, 1));
  OutsideRequests after_restart;
  bool looking = true;
  after_restart.watch_writers([&](const WriterId& id) { return looking || id == writer(2); });
  EXPECT_TRUE(after_restart.latch(Arbiter(state).living()).empty());
  looking = false;
  const auto items = after_restart.latch(Arbiter(state).living());
  ASSERT_EQ(items.size(), 1u);
  EXPECT_TRUE(items[0].died);
  EXPECT_EQ(items[0].source, "pilot");
  EXPECT_EQ(items[0].writer, writer(1));
}

TEST(UnansweredRequests, AreSaidAgainUntilTheyAreAnsweredAndTheirMomentHasNotPassed) {
  using namespace std::chrono_literals;
  UnansweredRequests unanswered;
  const auto start = std::chrono::steady_clock::time_point{};
  const auto repeated = [&](std::chrono::milliseconds at) {
    std::string numbers;
    unanswered.repeat(start + at, 500ms, [&](const msg::Request& r) { numbers += std::to_string(r.header.sequence_number); });
    return numbers;
  };
  unanswered.asked(request("x", kExternal, msg::kRequestTake, 1), start);
  unanswered.asked(motion("x", kExternal, 2), start);
  unanswered.asked(motion("x", kExternal, 3), start + 100ms);
  EXPECT_EQ(repeated(400ms), "");
  EXPECT_EQ(repeated(600ms), "13");  // the second motion took the first one's place
  EXPECT_EQ(repeated(700ms), "");
  unanswered.answered(1);
  EXPECT_EQ(repeated(1200ms), "3");
  unanswered.asked(request("x", kExternal, msg::kRequestEmergencyStop, 4), start + 1300ms);
  EXPECT_EQ(unanswered.stop(), 4u);
  EXPECT_EQ(repeated(2000ms), "4");  // no motion of before the stop
  unanswered.answered(4);
  EXPECT_EQ(unanswered.stop(), 0u);
  EXPECT_EQ(repeated(9000ms), "");
}

class Names : public ::testing::Test {
 protected:
  ArbiterState state_;
  Arbiter arbiter_{state_};
  Ruling::Kind kind(const msg::Request& r) { return arbiter_.decide_outside(r).kind; }
  msg::Request detached(const std::string& name, std::uint64_t number) {
    auto r = request(name, kOperator, msg::kRequestTake, number);
    r.detached = true;
    return r;
  }
};

TEST_F(Names, ARepeatedRequestIsRuledOnOnceAndAnsweredAsItWasThen) {
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTask, 1, 1)), Ruling::kForward);
  EXPECT_EQ(kind(request("b", kExternal, msg::kRequestTake, 4)), Ruling::kRefused);
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestRelease, 5)), Ruling::kCancelAll);
  EXPECT_EQ(state_.refused, 1u);
  const auto again = arbiter_.decide_outside(request("a", kExternal, msg::kRequestTask, 1, 1));
  EXPECT_EQ(again.kind, Ruling::kRepeated);
  EXPECT_TRUE(again.granted);
  const auto refused = arbiter_.decide_outside(request("b", kExternal, msg::kRequestTake, 4));
  EXPECT_EQ(refused.kind, Ruling::kRepeated);
  EXPECT_FALSE(refused.granted);
  EXPECT_TRUE(state_.holder.empty());
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTake, 3)), Ruling::kRefused);  // never heard, and overtaken
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTake, 70)), Ruling::kNothing);
  EXPECT_EQ(kind(request("a", kExternal, msg::kRequestTake, 5)), Ruling::kRefused);  // too long ago to be remembered
}

TEST_F(Names, AProcessThatTakesADeadOnesNameBeginsAnew) {
  arbiter_.decide_outside(request("p", kExternal, msg::kRequestTask, 57, 9), writer(1));
  EXPECT_FALSE(arbiter_.has_another_writer("p", writer(1)));
  EXPECT_TRUE(arbiter_.has_another_writer("p", writer(2)));
  EXPECT_EQ(arbiter_.on_death("p").kind, Ruling::kCancelAll);
  const auto first = arbiter_.decide_outside(request("p", kExternal, msg::kRequestTask, 1, 1), writer(2));
  EXPECT_EQ(first.kind, Ruling::kForward);
  EXPECT_FALSE(arbiter_.has_another_writer("p", writer(2)));
}

TEST_F(Names, ADetachedSourceIsForgottenWhenItIsDeadAndHoldsNothing) {
  for (int i = 0; i < 200; ++i) {
    const std::string name = "script" + std::to_string(i);
    ASSERT_EQ(kind(detached(name, 1)), i == 0 ? Ruling::kNothing : Ruling::kCancelAll) << state_.refusal;
    EXPECT_EQ(arbiter_.on_death(name).kind, Ruling::kNothing);
    EXPECT_EQ(state_.holder, name);
    EXPECT_EQ(state_.sources.size(), 1u);
  }
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestRelease, 1)), Ruling::kCancelAll);
  EXPECT_EQ(state_.sources.size(), 1u);  // the pilot
  EXPECT_EQ(kind(detached("late", 1)), Ruling::kNothing);
  EXPECT_EQ(kind(request("late", kOperator, msg::kRequestRelease, 2)), Ruling::kCancelAll);
  EXPECT_EQ(arbiter_.on_death("late").kind, Ruling::kNothing);
  EXPECT_FALSE(state_.sources.contains("late"));
}

TEST_F(Names, ADetachedHoldersSuccessorCountsItsRequestsAnewAndItsGoalsOn) {
  auto start = detached("script", 900);
  start.kind = msg::kRequestTask;
  start.goal_id = 0;
  const auto goal = arbiter_.decide_outside(start, writer(1)).goal_id;
  arbiter_.on_death("script");
  EXPECT_TRUE(arbiter_.living().empty());
  start.header.sequence_number = 1;
  EXPECT_EQ(arbiter_.decide_outside(start, writer(2)).goal_id, goal + 1);
  EXPECT_EQ(arbiter_.living().size(), 1u);
  EXPECT_EQ(kind(request("script", kOperator, msg::kRequestRelease, 2)), Ruling::kCancelAll);
}

TEST_F(Names, NamesThatComeAndGoNeedNoMoreMemoryThanTheLiving) {
  for (int i = 0; i < 1000; ++i) {
    const std::string name = "n" + std::to_string(i);
    kind(request(name, kExternal, msg::kRequestTake, 1));
    arbiter_.on_death(name);
  }
  EXPECT_TRUE(state_.sources.empty());
  for (int i = 0; i < 1000; ++i) kind(request("n" + std::to_string(i), kExternal, msg::kRequestRelease, 1));
  EXPECT_LE(state_.sources.size(), 64u);
  EXPECT_EQ(kind(request("last", kOperator, msg::kRequestEmergencyStop, 1)), Ruling::kCancelAll);
}

TEST_F(Names, ManyPlannersLeaveNamesForOperators) {
  for (int i = 0; i < 100; ++i) kind(request("n" + std::to_string(i), kExternal, msg::kRequestTake, 1));
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 1)), Ruling::kCancelAll) << state_.refusal;
  EXPECT_EQ(kind(request("another", kOperator, msg::kRequestEmergencyStop, 1)), Ruling::kCancelAll);
  EXPECT_EQ(kind(request("another", kOperator, msg::kRequestClearStop, 2)), Ruling::kNothing) << state_.refusal;
}

TEST_F(Names, ACancelThatTakesAuthorityEndsWhatRuns) {
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTask, 1, 1)), Ruling::kForward);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestRelease, 2)), Ruling::kCancelAll);
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTask, 1, 1)), Ruling::kForward);
  auto cancel = request("pilot", kOperator, msg::kRequestTask, 3, 1);
  cancel.command = msg::kCommandCancel;
  EXPECT_EQ(kind(cancel), Ruling::kCancelAll);  // not the pilot's old goal is to end, but the planner's
  EXPECT_EQ(state_.holder, "pilot");
}

}  // namespace
}  // namespace constrictor
