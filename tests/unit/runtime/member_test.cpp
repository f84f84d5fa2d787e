// One member of the barrier, called directly: when it steps, which messages it rejects, and how it resumes.
#include "barrier/member.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "member_fixture.hpp"

namespace constrictor {
namespace {

TEST_F(MemberTest, StepsOnceItsTickAndAllOfItsInputsAreThere) {
  const auto member = make();
  member->on_epoch(kEpoch, 1);
  EXPECT_FALSE(member->try_step());
  EXPECT_EQ(member->missing().topic, nullptr) << "it waits for a tick";
  member->on_tick(tick_at(0, visible(1, 2)));
  EXPECT_FALSE(member->try_step());
  give_joints(*member, 1);
  give_event(*member, 2);
  EXPECT_FALSE(member->try_step());
  ASSERT_NE(member->missing().topic, nullptr);
  EXPECT_EQ(member->missing().topic->id, topics::kTaskEvent.id);
  EXPECT_EQ(member->missing().want, 2u);
  give_event(*member, 1);
  EXPECT_TRUE(member->try_step());
  EXPECT_FALSE(member->try_step()) << "the member must step once for each tick";
  ASSERT_EQ(record_.steps.size(), 1u);
  EXPECT_EQ(record_.steps[0].index, 0);
  EXPECT_EQ(record_.steps[0].published.at(0).count, 1u);
  EXPECT_EQ(record_.published.size(), 1u);
}

TEST_F(MemberTest, MessagesThatArriveBeforeTheEpochIsKnownAreKept) {
  const auto member = make();
  member->on_tick(tick_at(0, visible(1, 1)));
  give_event(*member, 1);
  give_joints(*member, 1);
  EXPECT_FALSE(member->try_step());
  member->on_epoch(kEpoch, 1);
  EXPECT_TRUE(member->try_step());
  EXPECT_EQ(record_.steps.back().output_hash, undisturbed_hash(1));
}

TEST_F(MemberTest, ImpossibleMessagesAndMessagesOfAnotherEpochAreRejectedAndCounted) {
  const auto member = make();
  member->on_epoch(kEpoch, 1);
  auto rejected = [&, before = std::uint64_t{0}](const std::string& reason) mutable {
    EXPECT_EQ(member->counters().refused, ++before) << reason;
    EXPECT_NE(member->counters().last_refusal.find(reason), std::string::npos) << member->counters().last_refusal;
  };
  give_joints(*member, 1, {8, 1});
  rejected("joint_state: it belongs to another run or epoch");
  give_joints(*member, 1, {7, 2});
  rejected("joint_state: it belongs to another run or epoch");
  give_joints(*member, 100'000);
  rejected("joint_state.sequence_number");
  member->on_tick(tick_at(0, {}, {8, 1}));
  rejected("tick: it belongs to another run or epoch");
  member->on_tick(tick_at(-5));
  rejected("index -5");
  member->on_epoch({8, 1}, 1);
  rejected("epoch: it belongs to another run");
  msg::JointState not_a_number{};
  not_a_number.joint_count = 1;
  not_a_number.position_rad[0] = std::nan("");
  member->on_sample(topics::kJointState.id, sample_of(topics::kJointState, 1, not_a_number));
  rejected("joint_state.position_rad");
  EXPECT_EQ(member->epoch(), kEpoch);
  EXPECT_FALSE(member->try_step());
}

TEST_F(MemberTest, DuplicatesAreDroppedAndCountedSeparately) {
  const auto member = make();
  member->on_epoch(kEpoch, 1);
  for (int i = 0; i < 3; ++i) give_joints(*member, 1);
  EXPECT_EQ(member->counters().duplicates, 2u);
  EXPECT_EQ(member->counters().refused, 0u);
}

TEST_F(MemberTest, ARestartedMemberContinuesWithTheSameOutputs) {
  auto first = make();
  first->on_epoch(kEpoch, 1);
  for (std::int64_t k = 0; k < 4; ++k) {
    const auto count = static_cast<std::uint64_t>(k + 1);
    give_joints(*first, count);
    give_event(*first, count);
    first->on_tick(tick_at(k, visible(count, count)));
    ASSERT_TRUE(first->try_step());
  }
  const TickDone& last = record_.steps[2];
  Resume resume{"control", kEpoch, 2, last.index, 1, last.state, last.written};
  first.reset();

  MemberRecord after;
  const auto second = make(2, &after);
  second->on_epoch(kEpoch, 1);
  EXPECT_FALSE(second->in_epoch()) << "the restarted member must wait for its Resume";
  for (std::uint64_t number = 1; number <= 4; ++number) {
    give_event(*second, number);
    give_joints(*second, number);
  }
  for (std::int64_t k = 0; k < 4; ++k)
    second->on_tick(tick_at(k, visible(static_cast<std::uint64_t>(k + 1), static_cast<std::uint64_t>(k + 1))));
  second->on_resume(resume);
  ASSERT_EQ(after.published.size(), 1u) << "the member must publish its last output again";
  EXPECT_EQ(after.published[0].second.header->sequence_number, 3u);
  while (second->try_step()) {}
  ASSERT_EQ(after.steps.size(), 1u) << "the member must repeat only the lost step";
  EXPECT_EQ(after.steps[0].index, 3);
  EXPECT_EQ(after.steps[0].output_hash, undisturbed_hash(4));
  EXPECT_EQ(after.published.back().second.header->incarnation, 2u);
}

TEST_F(MemberTest, ADamagedCheckpointIsRejectedOrNamed) {
  const auto first = make_at_first_tick();
  ASSERT_TRUE(first->try_step());
  const TickDone& step = record_.steps.back();

  MemberRecord after;
  auto second = make(2, &after);
  Resume resume{"control", kEpoch, 2, 0, 1, step.state, step.written};
  resume.outputs.at(0).bytes.pop_back();
  second->on_resume(resume);
  EXPECT_FALSE(second->in_epoch());
  EXPECT_EQ(second->counters().last_refusal, "resume.checkpoint: damaged output");
  EXPECT_TRUE(after.published.empty());
  for (std::size_t size = 0; size < step.state.size(); ++size) {
    auto third = make(2, &after);
    const Resume cut{"control", kEpoch, 2, 0, 1, step.state.substr(0, size), {}};
    EXPECT_THROW(third->on_resume(cut), std::runtime_error) << size;
  }
}

TEST_F(MemberTest, AResumeForAnotherIncarnationChangesNothing) {
  const auto first = make();
  first->on_resume({"control", kEpoch, 1, 5, 1, "x", {}});
  EXPECT_FALSE(first->in_epoch());
  EXPECT_EQ(first->counters().refused, 1u) << "the first incarnation begins with an epoch";
  const auto second = make(2);
  second->on_resume({"control", kEpoch, 3, 5, 1, "x", {}});
  EXPECT_FALSE(second->in_epoch());
}

TEST_F(MemberTest, AResetBetweenHelloAndResumeBeginsTheNewEpoch) {
  const auto member = make(2);
  member->on_epoch({7, 2}, 5);
  member->on_resume({"control", kEpoch, 2, 40, 1, "state of the old epoch", {}});
  ASSERT_TRUE(member->in_epoch());
  EXPECT_EQ(member->epoch(), (EpochId{7, 2}));
  EXPECT_EQ(member->last_done(), -1);
  EXPECT_EQ(member->setup().seed, 5u);
}

TEST_F(MemberTest, AtRealTimePaceItStepsAtTheNewestTickAndCountsTheOthers) {
  const auto member = make();
  member->on_epoch(kEpoch, 1);
  give_joints(*member, 1);
  for (std::int64_t k = 0; k < 5; ++k) {
    msg::Tick tick = tick_at(k, visible(9, 9));
    tick.realtime = true;
    member->on_tick(tick);
  }
  EXPECT_TRUE(member->try_step());
  EXPECT_FALSE(member->try_step());
  EXPECT_EQ(member->last_done(), 4);
  EXPECT_EQ(member->counters().skipped, 4u);
}

TEST_F(MemberTest, AtRealTimePaceAnInputThatMissedManySamplesReceivesAgain) {
  const auto member = make();
  member->on_epoch(kEpoch, 1);
  const auto send_tick = [&](std::int64_t index) {
    msg::Tick tick = tick_at(index, visible(static_cast<std::uint64_t>(index) + 1, 0));
    tick.realtime = true;
    member->on_tick(tick);
  };
  give_joints(*member, 1);
  send_tick(0);
  ASSERT_TRUE(member->try_step());
  // The member was stopped while the plant wrote more samples than a sequence number may be ahead.
  send_tick(2 * InputBuffer::kFarthestAhead - 1);
  give_joints(*member, 2 * InputBuffer::kFarthestAhead);
  ASSERT_TRUE(member->try_step());
  EXPECT_EQ(member->counters().refused, 0u) << member->counters().last_refusal;
  std::uint64_t seen = 0;
  for (const auto& [topic, count] : record_.steps.back().consumed) {
    if (topic == topics::kJointState.id) seen = count;
  }
  EXPECT_EQ(seen, 2 * InputBuffer::kFarthestAhead);
}

TEST_F(MemberTest, TheFinalTickEndsItWithoutAStep) {
  const auto member = make();
  member->on_epoch(kEpoch, 1);
  msg::Tick last = tick_at(0);
  last.final_tick = true;
  member->on_tick(last);
  EXPECT_TRUE(member->ended());
  EXPECT_FALSE(member->try_step());
  EXPECT_TRUE(record_.steps.empty());
}

/// Writes more samples than the topic allows, and samples that violate their IDL.
class Careless : public Component {
 public:
  explicit Careless(Wiring& wiring) : command_(wiring.output(topics::kJointCommand)) {}
  void step(const Tick&) override {
    msg::JointCommand command{};
    command.joint_count = 1;
    command.position_rad[0] = std::nan("");
    command_.write(command);
    command.position_rad[0] = 0.5;
    for (int i = 0; i < 3; ++i) command_.write(command);
  }
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}

 private:
  Output<msg::JointCommand> command_;
};

TEST_F(MemberTest, InvalidOutputsAndTooManyOutputsDoNotLeaveTheMember) {
  const ComponentFactory factory{"control",
                                 [](Wiring& w, const constrictor::Setup&) { return std::make_unique<Careless>(w); }};
  Member member(factory, constrictor::Setup{}, 1, true, static_cast<MemberSink&>(record_));
  member.on_epoch(kEpoch, 1);
  member.on_tick(tick_at(0));
  ASSERT_TRUE(member.try_step());
  EXPECT_EQ(record_.published.size(), topics::kJointCommand.max_per_tick);
  EXPECT_EQ(member.counters().refused, 3u);
  EXPECT_NE(member.counters().last_refusal.find("more than 1 in one step"), std::string::npos);
}

}  // namespace
}  // namespace constrictor
