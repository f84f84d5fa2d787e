// A member whose step goes on while messages arrive.
#include <gtest/gtest.h>

#include <thread>

#include "member_fixture.hpp"

namespace constrictor {
namespace {

using MemberStepTest = MemberTest;

TEST_F(MemberStepTest, AStepInAnotherThreadSeesOnlyWhatIsVisibleAtItsTick) {
  const auto member = make();
  member->on_epoch(kEpoch, 1);
  constexpr std::int64_t kTicks = 200;
  for (std::int64_t k = 0; k < kTicks; ++k) {
    const auto count = static_cast<std::uint64_t>(k + 1);
    if (k == 0) {
      give_joints(*member, count);
      give_event(*member, count);
      member->on_tick(tick_at(k, visible(count, count)));
    }
    ASSERT_TRUE(member->begin_step());
    std::thread thread([&member] { member->run_step(); });
    // Meanwhile the messages of the next tick arrive.
    if (k + 1 < kTicks) {
      give_joints(*member, count + 1);
      give_event(*member, count + 1);
      member->on_tick(tick_at(k + 1, visible(count + 1, count + 1)));
    }
    EXPECT_FALSE(member->begin_step()) << "one step at a time";
    EXPECT_FALSE(member->has_due_tick()) << "it waits for no message";
    thread.join();
    EXPECT_EQ(record_.published.size(), static_cast<std::size_t>(k)) << "published before the step was finished";
    member->finish_step();
    EXPECT_EQ(record_.published.size(), count);
  }
  EXPECT_EQ(record_.steps.back().output_hash, undisturbed_hash(kTicks));
}

TEST_F(MemberStepTest, TheFinalTickDuringAStepEndsItAfterTheStep) {
  const auto member = make_at_first_tick();
  ASSERT_TRUE(member->begin_step());
  msg::Tick last = tick_at(1);
  last.final_tick = true;
  member->on_tick(last);
  EXPECT_FALSE(member->ended());
  member->run_step();
  member->finish_step();
  EXPECT_TRUE(member->ended());
  EXPECT_EQ(record_.steps.size(), 1u);
  EXPECT_FALSE(member->try_step());
}

TEST_F(MemberStepTest, AResetDropsTheOutputsOfAStepInProgress) {
  const auto member = make_at_first_tick();
  ASSERT_TRUE(member->begin_step());
  member->run_step();
  const EpochId next{kEpoch.run_id, kEpoch.epoch + 1};
  member->on_epoch(next, 1);
  EXPECT_FALSE(member->stepping());
  EXPECT_TRUE(record_.published.empty());
  EXPECT_TRUE(record_.steps.empty());
  give_joints(*member, 1, next);
  msg::Tick first = tick_at(0, visible(1, 0));
  first.epoch = next.epoch;
  member->on_tick(first);
  ASSERT_TRUE(member->try_step());
  EXPECT_EQ(record_.published.size(), 1u);
  EXPECT_EQ(record_.steps.at(0).written.size(), 1u) << "the checkpoint has an output of the dropped step";
}

}  // namespace
}  // namespace constrictor
