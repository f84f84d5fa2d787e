// The end of a member: what a component sees when it concludes, also if it was restarted after the final tick.
#include <gtest/gtest.h>

#include <optional>

#include "component/concluding.hpp"
#include "member_fixture.hpp"

namespace constrictor {
namespace {

/// What the component saw when it concluded.
struct Seen {
  std::optional<double> joint_rad;
  std::int64_t age_ticks = -1;
  std::size_t fresh_events = 0;
  std::int64_t last_tick = -1;
  bool operator==(const Seen&) const = default;
};

class Ending : public Stateful<Component, testing::toys::Mixer>, public Concluding {
 public:
  Ending(Wiring& wiring, Seen& seen)
      : seen_(seen), joints_(wiring.latest(topics::kJointState)), events_(wiring.events(topics::kTaskEvent)) {}
  void step(const Tick&) override { state_.mix(std::uint64_t{1}); }
  void conclude(const Tick& last) override {
    if (joints_) seen_.joint_rad = joints_->position_rad[0];
    seen_.age_ticks = joints_ ? joints_.age_ticks() : -1;
    for (const auto& event : events_) seen_.fresh_events += event.goal_id > 0 ? 1 : 0;
    seen_.last_tick = last.index;
  }

 private:
  Seen& seen_;
  Latest<msg::JointState> joints_;
  Events<msg::TaskEvent> events_;
};

class MemberEnd : public MemberTest {
 protected:
  std::unique_ptr<Member> make_ending(std::uint32_t incarnation, Seen& seen) {
    ComponentFactory factory{"report",
                             [&seen](Wiring& wiring, const constrictor::Setup&) -> std::unique_ptr<Component> {
                               return std::make_unique<Ending>(wiring, seen);
                             }};
    return std::make_unique<Member>(std::move(factory), constrictor::Setup{}, incarnation, /*checkpoints=*/true,
                                    static_cast<MemberSink&>(record_));
  }
  static msg::Tick final_tick(std::int64_t index) {
    msg::Tick tick = tick_at(index, visible(3, 3));
    tick.final_tick = true;
    return tick;
  }
  /// Does the steps 0 to 2, each of which sees one more joint state and one more event.
  std::unique_ptr<Member> after_three_steps(Seen& seen) {
    auto member = make_ending(1, seen);
    member->on_epoch(kEpoch, 1);
    for (std::uint64_t k = 0; k < 3; ++k) {
      give_joints(*member, k + 1);
      give_event(*member, k + 1);
      member->on_tick(tick_at(static_cast<std::int64_t>(k), visible(k + 1, k + 1)));
      EXPECT_TRUE(member->try_step());
    }
    return member;
  }
  /// A member that was killed after the final tick and has resumed; nothing has arrived for it yet.
  std::unique_ptr<Member> restarted(Seen& seen) {
    Seen lost;
    const auto first = after_three_steps(lost);
    const TickDone& last = record_.steps.back();
    auto second = make_ending(2, seen);
    second->on_resume({"report", kEpoch, 2, last.index, 1, last.state, last.written});
    EXPECT_TRUE(second->in_epoch());
    return second;
  }
};

TEST_F(MemberEnd, AComponentConcludesWithTheInputsOfItsLastStep) {
  Seen seen;
  const auto member = after_three_steps(seen);
  member->on_tick(final_tick(3));
  EXPECT_TRUE(member->ended());
  EXPECT_EQ(seen, (Seen{0.003, 2, 1, 2})) << "the fixture stamps all joint states with tick 0";
}

// DDS sends the history of writers again, in an order that is arbitrary between topics and the final tick.
TEST_F(MemberEnd, ARestartedComponentConcludesWhenTheInputsOfItsLastStepHaveArrivedAgain) {
  for (const bool tick_first : {true, false}) {
    Seen seen;
    const auto member = restarted(seen);
    if (tick_first) {
      member->on_tick(final_tick(3));
      EXPECT_TRUE(member->concluding());
      EXPECT_EQ(member->missing().topic->id, topics::kJointState.id);
    }
    for (const std::uint64_t number : {2, 3}) {
      EXPECT_FALSE(member->ended());
      give_joints(*member, number);
      give_event(*member, number);
    }
    if (!tick_first) member->on_tick(final_tick(3));
    EXPECT_TRUE(member->ended());
    EXPECT_FALSE(member->concluding());
    EXPECT_EQ(seen, (Seen{0.003, 2, 0, 2})) << "as without the restart, but no event is fresh";
  }
}

TEST_F(MemberEnd, WithoutTheInputsItConcludesOnRequestOnly) {
  Seen seen;
  const auto member = restarted(seen);
  member->conclude_anyway();
  EXPECT_FALSE(member->ended()) << "the run is not over";
}

TEST_F(MemberEnd, InputsThatNeverArriveCanBeGivenUp) {
  Seen seen;
  const auto member = restarted(seen);
  member->on_tick(final_tick(3));
  give_event(*member, 3);
  ASSERT_TRUE(member->concluding());
  member->conclude_anyway();
  EXPECT_TRUE(member->ended());
  EXPECT_EQ(seen.joint_rad, std::nullopt);
  EXPECT_EQ(seen.last_tick, 2);
}

// A member with latency may have steps to do when the final tick arrives. How many is a matter of chance, and must not
// show in the result.
TEST_F(MemberEnd, AComponentThatIsBehindDoesItsLastStepsBeforeItConcludes) {
  Seen seen;
  const auto member = after_three_steps(seen);
  member->on_tick(tick_at(3, visible(4, 4)));
  member->on_tick(tick_at(4, visible(5, 5)));
  member->on_tick(final_tick(5));
  EXPECT_FALSE(member->ended());
  EXPECT_TRUE(member->concluding());
  EXPECT_FALSE(member->try_step());
  EXPECT_EQ(member->missing().tick, 3);
  EXPECT_EQ(member->missing().topic->id, topics::kJointState.id);
  for (const std::uint64_t number : {4, 5}) {
    give_joints(*member, number);
    EXPECT_FALSE(member->ended());
    give_event(*member, number);
    EXPECT_TRUE(member->try_step());
  }
  EXPECT_TRUE(member->ended());
  EXPECT_FALSE(member->concluding());
  EXPECT_EQ(record_.steps.back().index, 4);
  EXPECT_EQ(seen, (Seen{0.005, 4, 1, 4})) << "as if it had never been behind";
}

// Ticks of a restarted plant and of its predecessor come from two writers, in an order that is arbitrary.
TEST_F(MemberEnd, ATickThatArrivesAfterTheFinalOneIsNotLeftOut) {
  Seen seen;
  const auto member = after_three_steps(seen);
  member->on_tick(final_tick(4));
  EXPECT_TRUE(member->concluding());
  EXPECT_EQ(member->missing().tick, 3);
  member->on_tick(tick_at(3, visible(3, 3)));
  EXPECT_TRUE(member->try_step());
  EXPECT_TRUE(member->ended());
  EXPECT_EQ(seen.last_tick, 3);
}

TEST_F(MemberEnd, StepsWhoseInputsNeverArriveCanBeGivenUp) {
  Seen seen;
  const auto member = after_three_steps(seen);
  member->on_tick(tick_at(3, visible(4, 4)));
  member->on_tick(final_tick(4));
  ASSERT_TRUE(member->concluding());
  member->conclude_anyway();
  EXPECT_TRUE(member->ended());
  EXPECT_EQ(seen.last_tick, 2);
}

TEST_F(MemberEnd, AResetEndsTheWaitForInputs) {
  Seen seen;
  const auto member = restarted(seen);
  member->on_tick(final_tick(3));
  member->on_epoch({kEpoch.run_id, kEpoch.epoch + 1}, 5);
  EXPECT_FALSE(member->concluding());
  EXPECT_EQ(seen, Seen{});
}

}  // namespace
}  // namespace constrictor
