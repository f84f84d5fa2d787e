// What a component receives from a topic with injected faults, in a run in one process.
#include "faults/faulty_component.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "barrier/local_run.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

using testing::scripted_plant;
using testing::StepFunction;

/// What a step has seen of the plant's joint state, in which position_rad[0] is the tick of the sample.
struct Seen {
  std::vector<double> fresh;  ///< contents
  double latest = -1;         ///< content of the newest sample; -1: none
  std::int64_t age = -1;      ///< [ticks] of its stamp
};

/// Writes down what its port shows, and hands the sum over. Its state is the sum.
class Reader : public StatefulComponent<double> {
 public:
  Reader(Wiring& wiring, bool events, std::map<std::int64_t, Seen>& seen)
      : seen_(seen), out_(wiring.output(topics::kMotionStatus)) {
    if (events) events_ = wiring.events(topics::kJointState);
    else latest_ = wiring.latest(topics::kJointState);
    is_events_ = events;
  }
  void step(const Tick& tick) override {
    Seen& seen = seen_[tick.index] = {};
    if (is_events_) {
      for (const auto& message : events_) seen.fresh.push_back(message.position_rad[0]);
    } else {
      if (latest_.fresh()) seen.fresh.push_back(latest_->position_rad[0]);
      if (latest_) seen.latest = latest_->position_rad[0];
      if (latest_) seen.age = latest_.age_ticks();
    }
    for (const double value : seen.fresh) state_ = 0.5 * state_ + value;
    msg::MotionStatus status{};
    status.phase_rad = state_;
    out_.write(status);
  }

 private:
  std::map<std::int64_t, Seen>& seen_;
  bool is_events_ = false;
  Events<msg::JointState> events_;
  Latest<msg::JointState> latest_;
  Output<msg::MotionStatus> out_;
};

class FaultyComponent : public ::testing::Test {
 protected:
  static TopicFault fault(TopicFault::Kind kind, double from_s, double until_s) {
    TopicFault fault;
    fault.kind = kind;
    fault.topic = &topics::kInfos[topics::kJointState.id];
    fault.from_ns = std::llround(from_s * 1e9);
    fault.until_ns = std::llround(until_s * 1e9);
    fault.number = 1;
    return fault;
  }
  std::unique_ptr<LocalRun> run(std::vector<TopicFault> faults, bool events, std::uint64_t seed = 1) {
    seen_.clear();
    auto plan = std::make_shared<FaultPlan>();
    plan->topics = std::move(faults);
    ComponentFactory plant = scripted_plant([](Wiring& wiring) -> StepFunction {
      return [out = wiring.output(topics::kJointState)](const Tick& tick) {
        msg::JointState state{};
        state.joint_count = 1;
        state.position_rad[0] = static_cast<double>(tick.index);
        out.write(state);
      };
    });
    ComponentFactory reader{"control", [this, events](Wiring& wiring, const constrictor::Setup&) {
                              return std::make_unique<Reader>(wiring, events, seen_);
                            }};
    constrictor::Setup setup;
    setup.seed = seed;
    return std::make_unique<LocalRun>(
        std::vector<ComponentFactory>{with_faults(plant, plan), with_faults(reader, plan)}, setup);
  }
  std::map<std::int64_t, Seen> seen_;
};

constexpr double kTick_s = 0.02;

TEST_F(FaultyComponent, ADroppedSampleNeverArrivesAndTheOneBeforeAges) {
  run({fault(TopicFault::Kind::kDrop, 3 * kTick_s, 6 * kTick_s)}, false)->advance(10);
  for (const auto& [tick, seen] : seen_) {
    const bool dropped = tick >= 3 && tick < 6;
    EXPECT_EQ(seen.fresh.empty(), dropped) << tick;
    EXPECT_EQ(seen.latest, dropped ? 2.0 : static_cast<double>(tick)) << tick;
    EXPECT_EQ(seen.age, dropped ? tick - 2 : 0) << tick;
  }
  EXPECT_EQ(seen_.size(), 10u);
}

TEST_F(FaultyComponent, ADelayedSampleArrivesWithItsOwnStampAndNeverReplacesANewerOne) {
  TopicFault late = fault(TopicFault::Kind::kDelay, 3 * kTick_s, 6 * kTick_s);
  late.delay_ticks = 2;
  run({late}, false)->advance(10);
  const double latest[] = {0, 1, 2, 2, 2, 3, 6, 7, 8, 9};
  for (const auto& [tick, seen] : seen_) {
    EXPECT_EQ(seen.latest, latest[tick]) << tick;
    EXPECT_EQ(seen.age, tick - std::lround(latest[tick])) << tick;
  }
  run({late}, true)->advance(10);
  EXPECT_EQ(seen_[5].fresh, (std::vector<double>{3}));
  EXPECT_EQ(seen_[6].fresh, (std::vector<double>{4, 6}));
  EXPECT_EQ(seen_[7].fresh, (std::vector<double>{5, 7}));
}

// As over a real link: reliable writers repeat what their history contains when the link is up again.
TEST_F(FaultyComponent, WhatWasSentWhileTheLinkWasDownArrivesAfterwardsAsFarAsTheHistoryReaches) {
  constexpr std::int64_t kDepth = topics::kJointState.depth;
  constexpr std::int64_t kFrom = 3, kUntil = kFrom + kDepth + 5;
  TopicFault down = fault(TopicFault::Kind::kLinkDown, kFrom * kTick_s, kUntil * kTick_s);
  down.readers = {"control"};
  run({down}, true)->advance(kUntil + 3);
  for (const auto& [tick, seen] : seen_) {
    std::vector<double> expected;
    for (std::int64_t k = kUntil - kDepth; tick == kUntil && k < kUntil; ++k)
      expected.push_back(static_cast<double>(k));
    if (tick < kFrom || tick >= kUntil) expected.push_back(static_cast<double>(tick));
    EXPECT_EQ(seen.fresh, expected) << tick;
  }
  run({down}, false)->advance(kUntil + 3);
  for (const auto& [tick, seen] : seen_)
    EXPECT_EQ(seen.latest, tick >= kFrom && tick < kUntil ? kFrom - 1.0 : static_cast<double>(tick)) << tick;
  down.readers = {"navigation"};
  run({down}, true)->advance(kUntil + 3);
  for (const auto& [tick, seen] : seen_)
    EXPECT_EQ(seen.fresh, std::vector<double>{static_cast<double>(tick)}) << "on the writer's side of the link";
}

TEST_F(FaultyComponent, ALinkThatStaysDownCarriesNothing) {
  TopicFault down = fault(TopicFault::Kind::kLinkDown, 3 * kTick_s, 1);
  down.until_ns = std::numeric_limits<std::int64_t>::max();
  run({down}, true)->advance(50);
  for (const auto& [tick, seen] : seen_) EXPECT_EQ(seen.fresh.empty(), tick >= 3) << tick;
}

TEST_F(FaultyComponent, ADuplicateArrivesTwiceForReadersOfEverySample) {
  const auto twice = fault(TopicFault::Kind::kDuplicate, 3 * kTick_s, 4 * kTick_s);
  run({twice}, true)->advance(6);
  EXPECT_EQ(seen_[3].fresh, (std::vector<double>{3, 3}));
  EXPECT_EQ(seen_[4].fresh, (std::vector<double>{4}));
  run({twice}, false)->advance(6);
  EXPECT_EQ(seen_[3].fresh, (std::vector<double>{3}));
}

TEST_F(FaultyComponent, AFrozenTopicRepeatsItsLastContentWithNewStamps) {
  run({fault(TopicFault::Kind::kFreeze, 3 * kTick_s, 6 * kTick_s)}, false)->advance(10);
  for (const auto& [tick, seen] : seen_) {
    EXPECT_EQ(seen.latest, tick >= 3 && tick < 6 ? 2.0 : static_cast<double>(tick)) << tick;
    EXPECT_EQ(seen.age, 0) << tick;
  }
}

TEST_F(FaultyComponent, ABiasIsAddedWhileItLasts) {
  TopicFault bias = fault(TopicFault::Kind::kBias, 3 * kTick_s, 6 * kTick_s);
  bias.field = "position_rad[0]";
  bias.amount = 100;
  run({bias}, false)->advance(10);
  for (const auto& [tick, seen] : seen_)
    EXPECT_EQ(seen.latest, static_cast<double>(tick) + (tick >= 3 && tick < 6 ? 100 : 0)) << tick;
}

TEST_F(FaultyComponent, ACorruptSampleIsEitherRefusedOrAValidMessage) {
  const auto damaged = run({fault(TopicFault::Kind::kCorrupt, 0, 1e6)}, false);
  damaged->advance(4000);
  // 4,000 samples of 64 * 3 numbers: a flipped bit of an exponent can make a number infinite, one of the count of
  // joints can make it too large. Both are refused. Nothing else is.
  const std::uint64_t refused = damaged->member("control").counters().refused;
  EXPECT_GT(refused, 0u);
  EXPECT_LT(refused, 400u);
  std::uint64_t missing = 0;
  for (const auto& [tick, seen] : seen_) missing += seen.fresh.empty();
  EXPECT_EQ(missing, refused);
  EXPECT_NE(damaged->member("control").counters().last_refusal.find("joint_state."), std::string::npos);
}

TEST_F(FaultyComponent, TheProbabilityIsThatOfTheSamplesAndTheSeedDecidesWhichOnes) {
  TopicFault half = fault(TopicFault::Kind::kDrop, 0, 1e6);
  half.probability = 0.3;
  const auto dropped = [&](std::uint64_t seed) {
    run({half}, false, seed)->advance(5000);
    std::vector<bool> missing;
    for (const auto& [tick, seen] : seen_) missing.push_back(seen.fresh.empty());
    return missing;
  };
  const auto first = dropped(1);
  EXPECT_NEAR(static_cast<double>(std::count(first.begin(), first.end(), true)), 1500, 5 * std::sqrt(5000 * 0.3 * 0.7));
  EXPECT_EQ(dropped(1), first);
  EXPECT_NE(dropped(2), first);
}

TEST_F(FaultyComponent, ARestartedComponentGoesOnWithTheSameFaults) {
  TopicFault late = fault(TopicFault::Kind::kDelay, 0, 1e6), frozen = fault(TopicFault::Kind::kFreeze, 0.1, 0.5);
  late.delay_ticks = 7;
  late.probability = 0.4;
  for (const bool events : {false, true}) {
    const auto plain = run({frozen, late}, events);
    plain->advance(60);
    const auto expected = plain->output_hashes();
    const auto restarted = run({frozen, late}, events);
    for (int i = 0; i < 60; ++i) {
      restarted->advance(1);
      if (i % 7 == 3) restarted->restart("control");
    }
    EXPECT_EQ(restarted->output_hashes(), expected);
  }
}

TEST_F(FaultyComponent, WithoutFaultsNothingIsPutBetween) {
  const ComponentFactory plain{"control", nullptr};
  EXPECT_EQ(with_faults(plain, std::make_shared<FaultPlan>()).create, nullptr);
  EXPECT_EQ(with_faults(plain, nullptr).create, nullptr);
}

}  // namespace
}  // namespace constrictor
