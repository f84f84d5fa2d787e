// The component `input` as a member of a run: its answers, commands, motions and authority.
#include <algorithm>
#include <random>
#include <set>

#include "input_run.hpp"
#include "two_writers.hpp"

namespace constrictor {
namespace {

TEST_F(InputMemberTest, AnswersEachRequestOfATick) {
  run({{4, {task(1)}}}, 20, {{5, [&] {
                                clients_->add(request("a", kExternal, msg::kRequestTask, 1, 7));
                                clients_->add(request("b", kExternal, msg::kRequestTake, 1));
                                clients_->add(request("z", kExternal, msg::kRequestEmergencyStop, 9));
                                clients_->add(request("pilot", kOperator, msg::kRequestTake, 3));
                              }}});
  std::map<std::string, msg::RequestAnswer> by_source;
  for (const auto& answer : answers_) EXPECT_TRUE(by_source.emplace(answer.source, answer).second) << answer.source;
  ASSERT_EQ(by_source.size(), 5u);
  EXPECT_TRUE(by_source["a"].granted == false &&
              by_source["a"].request_sequence == 1);  // the pilot has authority: its request came first
  EXPECT_NE(std::string(by_source["a"].reason).find("pilot"), std::string::npos);
  EXPECT_FALSE(by_source["b"].granted);
  EXPECT_TRUE(by_source["z"].granted && by_source["z"].request_sequence == 9);
  EXPECT_TRUE(by_source["pilot"].granted && by_source["pilot"].request_sequence == 3);
  EXPECT_FALSE(by_source["planner"].granted);
  EXPECT_EQ(authority_.back().answered_source, std::string("planner"));  // `authority` has only the last request
}

TEST_F(InputMemberTest, AnswersATaskWithItsGoalAndAnswersTheRequestsThatItRefuses) {
  run({}, 20, {{5, [&] {
                  for (std::uint64_t i = 1; i <= 4; ++i)
                    clients_->add(request("a", kExternal, msg::kRequestTask, i, i));
                  auto tune = request("a", kExternal, msg::kRequestParameter, 5);
                  std::copy_n("no.such", 8, tune.parameter);
                  clients_->add(tune);
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

TEST_F(InputMemberTest, ASourceWithAnotherWriterIsAnotherProcessAndTheFormerIsDead) {
  WriterId first{1};
  WriterId second{2};
  run({}, 30,
      {{5, [&] { clients_->add(request("p", kExternal, msg::kRequestTask, 57, 3), first); }},
       {9, [&] { clients_->add(request("p", kExternal, msg::kRequestTask, 58, 4), first); }},
       {15, [&] { clients_->add(request("p", kExternal, msg::kRequestTake, 1), second); }},
       {20, [&] { clients_->add(request("p", kExternal, msg::kRequestTask, 2, 1), second); }}});
  ASSERT_EQ(answers_.size(), 4u);
  for (const auto& answer : answers_) EXPECT_TRUE(answer.granted) << answer.reason;
  ASSERT_EQ(commands_.size(), 4u);
  EXPECT_EQ(commands_[2].command, msg::kCommandCancel);  // of the task of the dead process
  EXPECT_EQ(commands_[2].goal_id, commands_[1].goal_id);
  EXPECT_EQ(commands_[2].header.tick, 15);
  EXPECT_EQ(commands_[3].command, msg::kCommandStart);
  std::set<std::uint64_t> goals = {commands_[0].goal_id, commands_[1].goal_id, commands_[3].goal_id};
  EXPECT_EQ(goals.size(), 3u);
}

TEST_F(InputMemberTest, AHolderWithoutWriterIsDeadAndALateDeathDoesNotAffectItsSuccessor) {
  WriterId first{1};
  WriterId second{2};
  WriterId dead{9};
  run({}, 40,
      {{4, [&] { clients_->check_writers_with([&](const WriterId& id) { return id != dead; }); }},
       {5, [&] { clients_->add(request("p", kOperator, msg::kRequestTask, 1), first); }},
       {15, [&] { dead = first; }},
       {20,
        [&] {
          clients_->add(request("p", kOperator, msg::kRequestTask, 1), first);
          dead = {};
        }},
       {25, [&] {
          clients_->add(request("p", kOperator, msg::kRequestTask, 1), second);
          dead = first;
        }}});
  std::vector<std::pair<std::int64_t, std::uint8_t>> levels;
  for (const auto& a : authority_) {
    if (levels.empty() || levels.back().second != a.level) levels.emplace_back(a.header.tick, a.level);
  }
  const std::vector<std::pair<std::int64_t, std::uint8_t>> expected = {
      {0, 0}, {5, kOperator}, {15, 0}, {20, kOperator}};
  EXPECT_EQ(levels, expected);
  EXPECT_EQ(commands_.back().command, msg::kCommandStart);
}

TEST_F(InputMemberTest, AnswersAndCountsRequestsThatTheLatchDropped) {
  run({}, 20, {{5, [&] {
                  for (std::uint64_t i = 1; i <= 100; ++i)
                    clients_->add(request("x", kExternal, msg::kRequestMotion, i));
                  auto drive = request("x", kExternal, msg::kRequestMotion, 101);
                  drive.motion = msg::kMotionDrive;
                  drive.speed_m_s = 0.7;
                  clients_->add(drive);
                }}});
  ASSERT_EQ(motions_.size(), 1u);
  EXPECT_DOUBLE_EQ(motions_[0].speed_m_s, 0.7);
  EXPECT_TRUE(answers_.back().granted);
  EXPECT_EQ(answers_.back().request_sequence, 101u);
  EXPECT_FALSE(answers_.front().granted);
  EXPECT_EQ(authority_.back().refused_count, clients_->dropped());
  EXPECT_GT(clients_->dropped(), ClientRequests::kMostRefusals);
}

TEST_F(InputMemberTest, SendsThePlannersTasksInTheirOrderWithMappedIds) {
  run({{3, {task(1)}}, {10, {task(2), task(3)}}}, 20);
  ASSERT_EQ(commands_.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(commands_[i].goal_id, mapped_goal_id(kPlanner, 0, i + 1));
  EXPECT_EQ(commands_[0].header.tick, 4);
  EXPECT_EQ(authority_.back().level, kPlanner);
  EXPECT_EQ(authority_.back().goal_id, commands_[2].goal_id);
}

TEST_F(InputMemberTest, WritesAuthorityAtTheStartAndEvery50Ticks) {
  run({}, 120);
  ASSERT_EQ(authority_.size(), 3u);
  EXPECT_EQ(authority_[1].header.tick - authority_[0].header.tick, 50);
}

TEST_F(InputMemberTest, AStopOfAClientCancelsTheRunningTaskAndThePlannerIsRefused) {
  run({{2, {task(1)}}, {20, {task(2)}}}, 30,
      {{10, [&] { clients_->add(request("pilot", kOperator, msg::kRequestEmergencyStop, 1)); }}});
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].command, msg::kCommandCancel);
  EXPECT_EQ(commands_[1].goal_id, commands_[0].goal_id);
  EXPECT_TRUE(authority_.back().emergency_stop);
  EXPECT_EQ(authority_.back().level, msg::kAuthorityEmergencyStop);
  EXPECT_EQ(authority_.back().refused_count, 1u);
  EXPECT_NE(std::string(authority_.back().refusal).find("pilot"), std::string::npos);
}

TEST_F(InputMemberTest, DeathOfAnOperatorCancelsItsTask) {
  run({}, 30,
      {{5, [&] { clients_->add(request("pilot", kOperator, msg::kRequestTask, 1, 1)); }},
       {15, [&] { clients_->add_death("pilot"); }}});
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].command, msg::kCommandCancel);
  EXPECT_EQ(authority_.back().level, msg::kAuthorityNone);
}

TEST_F(InputMemberTest, AStopFindsRoomInATickFullOfTaskCommands) {
  run({}, 10, {{5, [&] {
                  for (std::uint64_t i = 1; i <= 6; ++i)
                    clients_->add(request("pilot", kOperator, msg::kRequestTask, i, i));
                  clients_->add(request("z", kExternal, msg::kRequestEmergencyStop, 1));
                }}});
  ASSERT_EQ(commands_.size(), 4u);
  EXPECT_EQ(commands_.back().command, msg::kCommandCancel);
  EXPECT_EQ(commands_.back().goal_id, commands_[2].goal_id);
}

TEST_F(InputMemberTest, ADirectMotionEndsWithItsSourceOrWithATask) {
  const auto drive = [](std::uint64_t sequence) {
    auto r = request("pilot", kOperator, msg::kRequestMotion, sequence);
    r.motion = msg::kMotionDrive;
    r.speed_m_s = 0.5;
    return r;
  };
  run({}, 40,
      {{5, [&] { clients_->add(drive(1)); }},
       {10, [&] { clients_->add_death("pilot"); }},
       {20, [&] { clients_->add(drive(2)); }},
       {25, [&] { clients_->add(request("pilot", kOperator, msg::kRequestTask, 3)); }},
       {30, [&] { clients_->add(request("pilot", kOperator, msg::kRequestRelease, 4)); }}});
  ASSERT_EQ(motions_.size(), 3u);
  EXPECT_EQ(motions_[0].motion, msg::kMotionDrive);
  EXPECT_EQ(motions_[0].header.tick, 5);
  EXPECT_EQ(motions_[1].motion, msg::kMotionStand);
  EXPECT_EQ(motions_[1].header.tick, 10);
  EXPECT_EQ(motions_[2].motion, msg::kMotionDrive);  // no stand at the release: the task had ended the motion
  ASSERT_EQ(commands_.size(), 2u);
  EXPECT_EQ(commands_[1].command, msg::kCommandCancel);
}

// Two writers of different levels send requests at the same time. tests/integration/two_writers_test.cpp repeats this
// with real processes.
TEST_F(InputMemberTest, TwoWritersOfDifferentLevelsAreNeverBothObeyed) {
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
    writers.add_request(r);
    requests[i * kTicks / kCommands].push_back(r);
  }
  std::map<std::int64_t, std::function<void()>> at;
  for (auto& [tick, now] : requests) {
    // The requests of the two sources interleave; each source keeps its own order.
    std::stable_partition(now.begin(), now.end(),
                          [even = tick % 2 == 0](const msg::Request& r) { return (r.level == kOperator) == even; });
    at[tick] = [this, &sent = now] {
      std::for_each(sent.begin(), sent.end(), [&](const auto& r) { clients_->add(r); });
    };
  }
  run({}, kTicks, at);
  const auto hear = [&](const auto& messages) {
    std::for_each(messages.begin(), messages.end(), [&](const auto& m) { writers.add(m); });
  };
  hear(answers_);
  hear(commands_);
  hear(motions_);
  hear(authority_);
  writers.check();
  EXPECT_EQ(writers.answered, kCommands);
  EXPECT_GT(writers.of_operator, 1000);
  EXPECT_GT(writers.of_external, 20);
  EXPECT_GT(writers.refused_to_external, 1000);
  EXPECT_GT(writers.ticks_of_both, 20) << "one source before a release, the other after it";
}

}  // namespace
}  // namespace constrictor
