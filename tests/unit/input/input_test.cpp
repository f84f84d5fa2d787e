// The arbiter, and `input` as a member of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <map>
#include <random>
#include <set>

#include "input/input.hpp"
#include "runtime/local_run.hpp"
#include "requests.hpp"
#include "two_writers.hpp"

namespace constrictor {
namespace {

class ArbiterTest : public ::testing::Test {
 protected:
  ArbiterState state_;
  Arbiter arbiter_{state_};
  Ruling decide(const msg::Request& r) { return r.level == kPlanner ? arbiter_.decide_planner(r) : arbiter_.decide_outside(r); }
  Ruling::Kind kind(const msg::Request& r) { return decide(r).kind; }
};

TEST_F(ArbiterTest, BuiltInPlannerTakesAuthorityByItsFirstTask) {
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 1)), Ruling::kForward);
  EXPECT_EQ(state_.holder, "planner");
}

TEST_F(ArbiterTest, AHigherLevelTakesOverAndALowerOneIsRefusedUntilRelease) {
  decide(request("planner", kPlanner, msg::kRequestTask, 1, 1));
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTask, 1)), Ruling::kForward);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 2, 2)), Ruling::kRefused);
  EXPECT_NE(state_.refusal.find("pilot"), std::string::npos);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestRelease, 2)), Ruling::kCancelAll);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 3, 3)), Ruling::kForward);
}

TEST_F(ArbiterTest, TakingAuthorityFromAnotherCancelsItsTaskAndFromNobodyDoesNothing) {
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTake, 1)), Ruling::kNothing);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 1)), Ruling::kCancelAll);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 2)), Ruling::kNothing);
}

TEST_F(ArbiterTest, ASecondSourceOfTheSameLevelIsRefused) {
  decide(request("a", kExternal, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("b", kExternal, msg::kRequestTask, 1)), Ruling::kRefused);
}

TEST_F(ArbiterTest, ReleaseByWhoDoesNotHoldIsRefused) {
  decide(request("a", kExternal, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("b", kExternal, msg::kRequestRelease, 1)), Ruling::kRefused);
  EXPECT_EQ(state_.holder, "a");
}

TEST_F(ArbiterTest, EmergencyStopLatchesOverEverybodyAndClearingStartsNoMotion) {
  decide(request("pilot", kOperator, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestEmergencyStop, 1)), Ruling::kCancelAll);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTask, 2, 2)), Ruling::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestClearStop, 1)), Ruling::kRefused);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestClearStop, 3)), Ruling::kNothing);
  EXPECT_EQ(state_.level, msg::kAuthorityNone);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestClearStop, 4)), Ruling::kRefused);  // there is none any more
}

TEST_F(ArbiterTest, OlderSequenceNumbersAndGoalsAreRefusedAndARepeatedNumberDoesNothing) {
  decide(request("planner", kPlanner, msg::kRequestTask, 5, 3));
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 5, 4)), Ruling::kRepeated);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 4, 4)), Ruling::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 6, 3)), Ruling::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 7, std::uint64_t{1} << 32)), Ruling::kRefused);
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestTask, 8, 4)), Ruling::kForward);
}

TEST_F(ArbiterTest, ValuesOutsideTheEnumerationsAreRefused) {
  auto r = request("x", kExternal, msg::kRequestTask, 1);
  r.task = msg::kTaskNone;
  EXPECT_EQ(kind(r), Ruling::kRefused);
  r = request("x", kExternal, msg::kRequestTask, 2);
  r.command = 7;
  EXPECT_EQ(kind(r), Ruling::kRefused);
  EXPECT_EQ(kind(request("x", kExternal, 99, 3)), Ruling::kRefused);
  EXPECT_EQ(kind(request("", kExternal, msg::kRequestTask, 4)), Ruling::kRefused);
  EXPECT_EQ(kind(request("x", msg::kAuthorityStop, msg::kRequestTask, 5)), Ruling::kRefused);
  EXPECT_EQ(state_.level, msg::kAuthorityNone);
  EXPECT_EQ(state_.refused, 5u);
}

TEST_F(ArbiterTest, AnybodyCanStopEvenWithARequestThatIsWrongOtherwise) {
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTask, 9)), Ruling::kForward);
  auto r = request("x", 77, msg::kRequestEmergencyStop, 9);  // unknown level, old sequence number
  EXPECT_EQ(kind(r), Ruling::kCancelAll);
  EXPECT_TRUE(state_.stopped);
}

TEST_F(ArbiterTest, ADirectMotionTakesAuthorityLikeATask) {
  decide(request("planner", kPlanner, msg::kRequestTask, 1));
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestMotion, 1)), Ruling::kMove);
  EXPECT_EQ(state_.holder, "x");
  EXPECT_EQ(kind(request("planner", kPlanner, msg::kRequestMotion, 2)), Ruling::kRefused);
  auto unknown = request("x", kExternal, msg::kRequestMotion, 2);
  unknown.motion = msg::kMotionCount;
  EXPECT_EQ(kind(unknown), Ruling::kRefused);
}

TEST_F(ArbiterTest, ADetachedHolderOutlivesItsWriterUntilItsEqualsTakeOverOrRelease) {
  auto script = request("script", kOperator, msg::kRequestTask, 1);
  script.detached = true;
  decide(script);
  EXPECT_EQ(arbiter_.on_death("script").kind, Ruling::kNothing);
  EXPECT_EQ(state_.holder, "script");
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestRelease, 1)), Ruling::kRefused);
  EXPECT_EQ(kind(request("x", kExternal, msg::kRequestTask, 2)), Ruling::kRefused);
  EXPECT_EQ(kind(request("pilot", kOperator, msg::kRequestTake, 1)), Ruling::kCancelAll);
  EXPECT_EQ(kind(request("other", kOperator, msg::kRequestTake, 1)), Ruling::kRefused);  // the pilot sits there
  decide(request("pilot", kOperator, msg::kRequestRelease, 2));
  script.header.sequence_number = 2;
  script.goal_id = 0;
  EXPECT_EQ(decide(script).goal_id, mapped_goal_id(kOperator, 5, 1));  // it was forgotten when it lost authority: a fifth source, its first goal
  EXPECT_EQ(kind(request("other", kOperator, msg::kRequestRelease, 2)), Ruling::kCancelAll);
  EXPECT_EQ(state_.level, msg::kAuthorityNone);
}

TEST_F(ArbiterTest, ARefusalSaysWhoseRequestItWas) {
  decide(request("planner", kPlanner, msg::kRequestTask, 1));
  decide(request("x", kExternal, msg::kRequestRelease, 41));
  decide(request("x", kExternal, msg::kRequestTake, 42));
  EXPECT_EQ(state_.refused_source, "x");
  EXPECT_EQ(state_.refused_sequence, 41u);
  EXPECT_EQ(state_.ruled_sequence, 42u);
  decide(request("\x1b[2J", kExternal, msg::kRequestTake, 1));
  EXPECT_EQ(state_.refused_source, "?");  // what is written to a terminal holds no escapes
}

TEST_F(ArbiterTest, NobodyOutsideActsAsTheBuiltInPlanner) {
  EXPECT_EQ(arbiter_.decide_outside(request("planner", kPlanner, msg::kRequestTask, 1)).kind, Ruling::kRefused);
  decide(request("planner", kPlanner, msg::kRequestTask, 1));
  EXPECT_EQ(arbiter_.decide_outside(request("planner", kOperator, msg::kRequestTask, 2, 2)).kind, Ruling::kRefused);
}

TEST_F(ArbiterTest, DeathOfTheHolderLeavesAuthorityWithNobody) {
  decide(request("pilot", kOperator, msg::kRequestTask, 1));
  EXPECT_EQ(arbiter_.on_death("planner").kind, Ruling::kNothing);
  EXPECT_EQ(arbiter_.on_death("pilot").kind, Ruling::kCancelAll);
  EXPECT_TRUE(state_.holder.empty());
}

TEST_F(ArbiterTest, ACancelNamesTheGoalThatItsSourceStarted) {
  const auto started = decide(request("x", kExternal, msg::kRequestTask, 1, 7)).goal_id;
  auto cancel = request("x", kExternal, msg::kRequestTask, 2, 7);
  cancel.command = msg::kCommandCancel;
  EXPECT_EQ(decide(cancel).goal_id, started);
  cancel.header.sequence_number = 3;
  cancel.goal_id = 8;
  EXPECT_EQ(kind(cancel), Ruling::kRefused);
}

TEST_F(ArbiterTest, GoalIdsOfDifferentSourcesNeverCollide) {
  std::set<std::uint64_t> ids;
  std::uint64_t sequence = 0;
  for (std::uint64_t goal = 1; goal <= 50; ++goal) {
    for (const auto& [source, level] : std::vector<std::pair<std::string, std::uint8_t>>{
             {"planner", kPlanner}, {"a", kExternal}, {"b", kExternal}, {"c", kOperator}}) {
      const auto ruling = decide(request(source, level, msg::kRequestTask, ++sequence, goal));
      ASSERT_EQ(ruling.kind, Ruling::kForward);
      EXPECT_TRUE(ids.insert(ruling.goal_id).second);
      decide(request(source, level, msg::kRequestRelease, ++sequence));
    }
  }
}

// Stated independently of the arbiter: a task goes through only if its source holds authority or outranks who does, and never
// while stopped; nothing but the requests that may change the holder does.
TEST_F(ArbiterTest, RandomRequestsNeverPassTheHolderOrAStop) {
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
    const auto ruling = kind(request(name, level, what, sequence, sequence));
    if (ruling == Ruling::kForward || ruling == Ruling::kMove) {
      ++forwarded;
      EXPECT_EQ(what, ruling == Ruling::kForward ? msg::kRequestTask : msg::kRequestMotion);
      EXPECT_FALSE(before.stopped);
      EXPECT_TRUE(before.holder == name || level > before.level);
      EXPECT_EQ(state_.holder, name);
    } else if (ruling == Ruling::kRefused) {
      EXPECT_EQ(state_.holder, before.holder);
      EXPECT_EQ(state_.level, before.level);
      EXPECT_EQ(state_.stopped, before.stopped);
      EXPECT_EQ(state_.refused, before.refused + 1);
    }
  }
  EXPECT_GT(forwarded, 100);
}

// ---- as a member of a run ----

struct Nothing {
  int steps = 0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(steps);
  }
};

class IdlePlant : public Plant {
 public:
  void sample(const Tick&) override {}
  void step(const Tick&) override {}
  [[nodiscard]] std::int64_t period_ns() const override { return 20'000'000; }
};

using Script = std::map<std::int64_t, std::vector<msg::Request>>;

/// Writes planner requests by tick.
class ScriptedPlanner : public StatefulComponent<Nothing> {
 public:
  ScriptedPlanner(Wiring& wiring, Script script) : script_(std::move(script)), request_(wiring.output(topics::kPlannerRequest)) {}
  void step(const Tick& tick) override {
    const auto entry = script_.find(tick.index);
    if (entry == script_.end()) return;
    for (const auto& r : entry->second) request_.write(r);
  }

 private:
  Script script_;
  Output<msg::Request> request_;
};

std::vector<ComponentFactory> members(std::shared_ptr<OutsideRequests> outside, const Script& script) {
  return {{"physics", [](Wiring&, const Setup&) { return std::make_unique<IdlePlant>(); }},
          make_input_factory(std::move(outside)),
          {"planner", [&script](Wiring& wiring, const Setup&) { return std::make_unique<ScriptedPlanner>(wiring, script); }}};
}

class InputMemberTest : public ::testing::Test {
 protected:
  void run(const Script& script, std::int64_t ticks, std::map<std::int64_t, std::function<void()>> at = {}) {
    outside_ = std::make_shared<OutsideRequests>();
    LocalRun local(members(outside_, script), constrictor::Setup{});
    local.subscribe(topics::kTaskCommand, std::function<void(const msg::TaskCommand&)>([&](const auto& m) { commands_.push_back(m); }));
    local.subscribe(topics::kAuthority, std::function<void(const msg::Authority&)>([&](const auto& m) { authority_.push_back(m); }));
    local.subscribe(topics::kRequestAnswer, std::function<void(const msg::RequestAnswer&)>([&](const auto& m) { answers_.push_back(m); }));
    local.subscribe(topics::kMotionCommand, std::function<void(const msg::MotionCommand&)>([&](const auto& m) { motions_.push_back(m); }));
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      if (const auto entry = at.find(tick); entry != at.end()) entry->second();
      local.advance(1);
    }
  }
  static msg::Request task(std::uint64_t goal) { return request("planner", kPlanner, msg::kRequestTask, 0, goal); }

  std::shared_ptr<OutsideRequests> outside_;
  std::vector<msg::TaskCommand> commands_;
  std::vector<msg::MotionCommand> motions_;
  std::vector<msg::Authority> authority_;
  std::vector<msg::RequestAnswer> answers_;
};

TEST_F(InputMemberTest, EveryRequestOfATickIsAnsweredByItself) {
  run({{4, {task(1)}}}, 20, {{5, [&] {
        outside_->add(request("a", kExternal, msg::kRequestTask, 1, 7));
        outside_->add(request("b", kExternal, msg::kRequestTake, 1));
        outside_->add(request("z", kExternal, msg::kRequestEmergencyStop, 9));
        outside_->add(request("pilot", kOperator, msg::kRequestTake, 3));
      }}});
  std::map<std::string, msg::RequestAnswer> by_source;
  for (const auto& answer : answers_) EXPECT_TRUE(by_source.emplace(answer.source, answer).second) << answer.source;
  ASSERT_EQ(by_source.size(), 5u);
  EXPECT_TRUE(by_source["a"].granted == false && by_source["a"].request_sequence == 1);  // the pilot, ruled on first, has authority
  EXPECT_NE(std::string(by_source["a"].reason).find("pilot"), std::string::npos);
  EXPECT_FALSE(by_source["b"].granted);
  EXPECT_TRUE(by_source["z"].granted && by_source["z"].request_sequence == 9);
  EXPECT_TRUE(by_source["pilot"].granted && by_source["pilot"].request_sequence == 3);
  EXPECT_FALSE(by_source["planner"].granted);
  EXPECT_EQ(authority_.back().ruled_source, std::string("planner"));  // `authority` has room for the last alone
}

TEST_F(InputMemberTest, TheAnswerToATaskNamesItsGoalAndWhatInputItselfRefusesIsAnsweredToo) {
  run({}, 20, {{5, [&] {
        for (std::uint64_t i = 1; i <= 4; ++i) outside_->add(request("a", kExternal, msg::kRequestTask, i, i));
        auto tune = request("a", kExternal, msg::kRequestParameter, 5);
        std::copy_n("no.such", 8, tune.parameter);
        outside_->add(tune);
      }}});
  ASSERT_EQ(answers_.size(), 5u);
  ASSERT_EQ(commands_.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_TRUE(answers_[i].granted);
    EXPECT_EQ(answers_[i].goal_id, commands_[i].goal_id);
  }
  EXPECT_FALSE(answers_[3].granted);  // a fourth task in one tick
  EXPECT_EQ(answers_[3].goal_id, 0u);
  EXPECT_FALSE(answers_[4].granted);
  EXPECT_NE(std::string(answers_[4].reason).find("no.such"), std::string::npos);
}

TEST_F(InputMemberTest, WhoSpeaksThroughAnotherWriterIsAnotherProcessAndTheFormerIsDead) {
  WriterId first{1};
  WriterId second{2};
  run({}, 30, {{5, [&] { outside_->add(request("p", kExternal, msg::kRequestTask, 57, 3), first); }},
               {9, [&] { outside_->add(request("p", kExternal, msg::kRequestTask, 58, 4), first); }},
               {15, [&] { outside_->add(request("p", kExternal, msg::kRequestTake, 1), second); }},
               {20, [&] { outside_->add(request("p", kExternal, msg::kRequestTask, 2, 1), second); }}});
  ASSERT_EQ(answers_.size(), 4u);
  for (const auto& answer : answers_) EXPECT_TRUE(answer.granted) << answer.reason;
  ASSERT_EQ(commands_.size(), 4u);
  EXPECT_EQ(commands_[2].command, msg::kCommandCancel);  // of the dead one's task
  EXPECT_EQ(commands_[2].goal_id, commands_[1].goal_id);
  EXPECT_EQ(commands_[2].header.tick, 15);
  EXPECT_EQ(commands_[3].command, msg::kCommandStart);
  std::set<std::uint64_t> goals = {commands_[0].goal_id, commands_[1].goal_id, commands_[3].goal_id};
  EXPECT_EQ(goals.size(), 3u);
}

TEST_F(InputMemberTest, AHolderWhoseWriterIsGoneIsDeadAndALateDeathDoesNotHitItsSuccessor) {
  WriterId first{1};
  WriterId second{2};
  WriterId dead{9};
  run({}, 40, {{4, [&] { outside_->watch_writers([&](const WriterId& id) { return id != dead; }); }},
               {5, [&] { outside_->add(request("p", kOperator, msg::kRequestTask, 1), first); }},
               {15, [&] { dead = first; }},
               {20, [&] { outside_->add(request("p", kOperator, msg::kRequestTask, 1), first); dead = {}; }},
               {25, [&] { outside_->add(request("p", kOperator, msg::kRequestTask, 1), second); dead = first; }}});
  std::vector<std::pair<std::int64_t, std::uint8_t>> levels;
  for (const auto& a : authority_) {
    if (levels.empty() || levels.back().second != a.level) levels.emplace_back(a.header.tick, a.level);
  }
  const std::vector<std::pair<std::int64_t, std::uint8_t>> expected = {{0, 0}, {5, kOperator}, {15, 0}, {20, kOperator}};
  EXPECT_EQ(levels, expected);
  EXPECT_EQ(commands_.back().command, msg::kCommandStart);
}

TEST_F(InputMemberTest, WhatFindsNoRoomInTheLatchIsAnsweredAndCounted) {
  run({}, 20, {{5, [&] {
        for (std::uint64_t i = 1; i <= 100; ++i) outside_->add(request("x", kExternal, msg::kRequestMotion, i));
        auto drive = request("x", kExternal, msg::kRequestMotion, 101);
        drive.motion = msg::kMotionDrive;
        drive.frequency_hz = 0.7;
        outside_->add(drive);
      }}});
  ASSERT_EQ(motions_.size(), 1u);
  EXPECT_DOUBLE_EQ(motions_[0].frequency_hz, 0.7);
  EXPECT_TRUE(answers_.back().granted);
  EXPECT_EQ(answers_.back().request_sequence, 101u);
  EXPECT_FALSE(answers_.front().granted);
  EXPECT_EQ(authority_.back().refused_count, outside_->dropped());
  EXPECT_GT(outside_->dropped(), OutsideRequests::kMostRefusals);
}

TEST_F(InputMemberTest, ForwardsThePlannersTasksInTheirOrderWithMappedIds) {
  run({{3, {task(1)}}, {10, {task(2), task(3)}}}, 20);
  ASSERT_EQ(commands_.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(commands_[i].goal_id, mapped_goal_id(kPlanner, 0, i + 1));
  EXPECT_EQ(commands_[0].header.tick, 4);
  EXPECT_EQ(authority_.back().level, kPlanner);
  EXPECT_EQ(authority_.back().goal_id, commands_[2].goal_id);
}

TEST_F(InputMemberTest, AuthorityIsSaidAtFirstAndEvery50Ticks) {
  run({}, 120);
  ASSERT_EQ(authority_.size(), 3u);
  EXPECT_EQ(authority_[1].header.tick - authority_[0].header.tick, 50);
}

TEST_F(InputMemberTest, AStopFromOutsideCancelsTheRunningTaskAndThePlannerIsRefused) {
  run({{2, {task(1)}}, {20, {task(2)}}}, 30,
      {{10, [&] { outside_->add(request("pilot", kOperator, msg::kRequestEmergencyStop, 1)); }}});
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].command, msg::kCommandCancel);
  EXPECT_EQ(commands_[1].goal_id, commands_[0].goal_id);
  EXPECT_TRUE(authority_.back().emergency_stop);
  EXPECT_EQ(authority_.back().level, msg::kAuthorityStop);
  EXPECT_EQ(authority_.back().refused_count, 1u);
  EXPECT_NE(std::string(authority_.back().refusal).find("pilot"), std::string::npos);
}

TEST_F(InputMemberTest, DeathOfAnOperatorCancelsItsTask) {
  run({}, 30, {{5, [&] { outside_->add(request("pilot", kOperator, msg::kRequestTask, 1, 1)); }},
               {15, [&] { outside_->add_death("pilot"); }}});
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].command, msg::kCommandCancel);
  EXPECT_EQ(authority_.back().level, msg::kAuthorityNone);
}

TEST_F(InputMemberTest, AStopFindsRoomInATickFullOfTasks) {
  run({}, 10, {{5, [&] {
                  for (std::uint64_t i = 1; i <= 6; ++i) outside_->add(request("pilot", kOperator, msg::kRequestTask, i, i));
                  outside_->add(request("z", kExternal, msg::kRequestEmergencyStop, 1));
                }}});
  ASSERT_EQ(commands_.size(), 4u);
  EXPECT_EQ(commands_.back().command, msg::kCommandCancel);
  EXPECT_EQ(commands_.back().goal_id, commands_[2].goal_id);
}

TEST_F(InputMemberTest, ADirectMotionEndsWithItsSourceAndATaskEndsItToo) {
  const auto drive = [](std::uint64_t sequence) {
    auto r = request("pilot", kOperator, msg::kRequestMotion, sequence);
    r.motion = msg::kMotionDrive;
    r.frequency_hz = 0.5;
    return r;
  };
  run({}, 40, {{5, [&] { outside_->add(drive(1)); }},
               {10, [&] { outside_->add_death("pilot"); }},
               {20, [&] { outside_->add(drive(2)); }},
               {25, [&] { outside_->add(request("pilot", kOperator, msg::kRequestTask, 3)); }},
               {30, [&] { outside_->add(request("pilot", kOperator, msg::kRequestRelease, 4)); }}});
  ASSERT_EQ(motions_.size(), 3u);
  EXPECT_EQ(motions_[0].motion, msg::kMotionDrive);
  EXPECT_EQ(motions_[0].header.tick, 5);
  EXPECT_EQ(motions_[1].motion, msg::kMotionStand);
  EXPECT_EQ(motions_[1].header.tick, 10);
  EXPECT_EQ(motions_[2].motion, msg::kMotionDrive);  // and no stand at the release: the task had ended the motion
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].command, msg::kCommandCancel);
}

// Two writers of different strength at once: whose word goes on is decided by the strongest that holds, tick by tick. With real
// writers and processes: tests/integration/two_writers_test.cpp.
TEST_F(InputMemberTest, TwoWritersOfDifferentStrengthAreNeverBothObeyed) {
  constexpr unsigned kSeed = 20261121;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  constexpr std::int64_t kTicks = 4000;
  constexpr int kCommands = 12000;
  TwoWriters writers;
  std::map<std::string, std::uint64_t> sequence;
  std::map<std::int64_t, std::vector<msg::Request>> requests;
  for (int i = 0; i < kCommands; ++i) {
    const bool operates = random() % 2 == 0;
    std::uint8_t kind = random() % 2 == 0 ? msg::kRequestTask : msg::kRequestMotion;
    if (operates && random() % 20 == 0) kind = msg::kRequestRelease;
    const std::string name = operates ? "pilot" : "machine";
    auto r = request(name, operates ? kOperator : kExternal, kind, ++sequence[name], 0);
    r.motion = msg::kMotionDrive;
    writers.asked(r);
    requests[i * kTicks / kCommands].push_back(r);
  }
  std::map<std::int64_t, std::function<void()>> at;
  for (auto& [tick, now] : requests) {
    // The two write at once: their words interleave, each keeping its own order.
    std::stable_partition(now.begin(), now.end(), [even = tick % 2 == 0](const msg::Request& r) { return (r.level == kOperator) == even; });
    at[tick] = [&] { std::for_each(now.begin(), now.end(), [&](const auto& r) { outside_->add(r); }); };
  }
  run({}, kTicks, at);
  const auto hear = [&](const auto& messages) { std::for_each(messages.begin(), messages.end(), [&](const auto& m) { writers.heard(m); }); };
  hear(answers_);
  hear(commands_);
  hear(motions_);
  hear(authority_);
  writers.judge();
  EXPECT_EQ(writers.answered, kCommands);
  EXPECT_GT(writers.of_operator, 1000);
  EXPECT_GT(writers.of_external, 20);
  EXPECT_GT(writers.refused_to_external, 1000);
  EXPECT_GT(writers.ticks_of_both, 20) << "one before a release, the other after it";
}

}  // namespace
}  // namespace constrictor
