// One member of the barrier, called directly.
#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "barrier/member.hpp"
#include "barrier_fixture.hpp"
#include "toy_components.hpp"

namespace constrictor {

/// The toy `control`: reads the latest joint state and every task event, writes a joint command in each step.
class MemberTest : public ::testing::Test {
 protected:
  std::unique_ptr<Member> make(std::uint32_t incarnation = 1, MemberRecord* record = nullptr) {
    return std::make_unique<Member>(testing::toys::control(), constrictor::Setup{}, incarnation, /*checkpoints=*/true,
                                    static_cast<MemberSink&>(record ? *record : record_));
  }
  static std::vector<TickDone::Count> visible(std::uint64_t joints, std::uint64_t events) {
    return {{topics::kJointState.id, joints}, {topics::kTaskEvent.id, events}};
  }
  static void give_joints(Member& member, std::uint64_t number, const EpochId& epoch = kEpoch) {
    msg::JointState state{};
    state.joint_count = 1;
    state.position_rad[0] = 0.001 * static_cast<double>(number);
    member.on_sample(topics::kJointState.id, sample_of(topics::kJointState, number, state, 1, epoch));
  }
  static void give_event(Member& member, std::uint64_t number) {
    msg::TaskEvent event{};
    event.goal_id = 10 + number;
    member.on_sample(topics::kTaskEvent.id, sample_of(topics::kTaskEvent, number, event));
  }
  /// A member that has all it needs for the step of the first tick: one joint state, and no event.
  std::unique_ptr<Member> make_at_first_tick() {
    auto member = make();
    member->on_epoch(kEpoch, 1);
    give_joints(*member, 1);
    member->on_tick(tick_at(0, visible(1, 0)));
    return member;
  }
  /// Output hash after `ticks` steps of a member that nothing happened to.
  static std::array<std::uint8_t, 32> undisturbed_hash(std::int64_t ticks) {
    MemberRecord record;
    Member member(testing::toys::control(), constrictor::Setup{}, 1, true, static_cast<MemberSink&>(record));
    member.on_epoch(kEpoch, 1);
    for (std::int64_t k = 0; k < ticks; ++k) {
      const auto count = static_cast<std::uint64_t>(k + 1);
      give_joints(member, count);
      give_event(member, count);
      member.on_tick(tick_at(k, visible(count, count)));
      EXPECT_TRUE(member.try_step());
    }
    return record.steps.back().output_hash;
  }
  MemberRecord record_;
};

}  // namespace constrictor
