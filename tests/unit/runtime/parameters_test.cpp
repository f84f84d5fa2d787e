// Run-time parameters in the barrier: in force from their tick on, in an order that arrival does not change, and through a crash.
#include "runtime/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "runtime/local_run.hpp"

namespace constrictor {
namespace {

constexpr const char* kGain = "control.wave.gain";
constexpr const char* kImages = "control.watch.images";

struct Asked {
  std::int64_t at;  ///< tick of the step that writes the change
  std::string name;
  double value;
  std::int64_t effective_tick;
};

class Plant20ms : public Plant {
 public:
  void sample(const Tick&) override {}
  void step(const Tick&) override {}
  [[nodiscard]] std::int64_t period_ns() const override { return 20'000'000; }
};

/// Writes changes as told.
class ScriptedInput : public StatefulComponent<int> {
 public:
  ScriptedInput(Wiring& wiring, const std::vector<Asked>& script) : script_(script), out_(wiring.output(topics::kParameterChange)) {}
  void step(const Tick& tick) override {
    for (const auto& asked : script_) {
      if (asked.at != tick.index) continue;
      msg::ParameterChange change{};
      std::snprintf(change.name, sizeof change.name, "%s", asked.name.c_str());
      change.value = asked.value;
      change.effective_tick = asked.effective_tick;
      out_.write(change);
    }
  }

 private:
  const std::vector<Asked>& script_;
  Output<msg::ParameterChange> out_;
};

/// What a step saw.
struct Seen {
  double gain = 0.0;
  int images = 0;
  bool changed = false;
  bool operator==(const Seen&) const = default;
};

struct OwnerState {
  ParameterState parameters;
  double sum = 0.0;  ///< depends on every step's values
  template <class Archive>
  void serialize(Archive& archive) {
    archive(parameters, sum);
  }
};

class Owner : public StatefulComponent<OwnerState> {
 public:
  Owner(Wiring& wiring, std::uint16_t period, std::map<std::int64_t, Seen>& seen)
      : parameters_(wiring, topics::kControlParameters), period_(period), seen_(seen), out_(wiring.output(topics::kMotionStatus)) {
    parameters_.add(gain_, "wave.gain", "1/m", {0.0, 2.0}, "a gain");
    parameters_.add(images_, "watch.images", "", {1.0, 10.0}, "a number of images");
  }
  [[nodiscard]] Timing timing() const override { return {period_, 1}; }
  void step(const Tick& tick) override {
    const bool changed = parameters_.step(tick, state_.parameters);
    seen_[tick.index] = {gain_, images_, changed};
    state_.sum = std::fmod(1.7 * state_.sum + gain_ * images_, 1000.0);
    msg::MotionStatus status{};
    status.phase_rad = state_.sum;
    out_.write(status);
  }

 private:
  double gain_ = 0.5;
  int images_ = 3;
  Parameters parameters_;
  std::uint16_t period_;
  std::map<std::int64_t, Seen>& seen_;
  Output<msg::MotionStatus> out_;
};

class ParametersTest : public ::testing::Test {
 protected:
  std::unique_ptr<LocalRun> make(std::uint16_t period = 1) {
    return std::make_unique<LocalRun>(
        std::vector<ComponentFactory>{
            {"physics", [](Wiring&, const constrictor::Setup&) { return std::make_unique<Plant20ms>(); }},
            {"input", [this](Wiring& w, const constrictor::Setup&) { return std::make_unique<ScriptedInput>(w, script_); }},
            {"control", [this, period](Wiring& w, const constrictor::Setup&) { return std::make_unique<Owner>(w, period, seen_); }}},
        constrictor::Setup{});
  }
  static msg::Parameter find(const LocalRun& run, const std::string& name) {
    const auto* list = run.latest(topics::kControlParameters);
    for (std::size_t i = 0; list && i < list->count; ++i) {
      if (name == list->parameters[i].name) return list->parameters[i];
    }
    ADD_FAILURE() << name << " is not announced";
    return {};
  }

  std::vector<Asked> script_;
  std::map<std::int64_t, Seen> seen_;
};

TEST_F(ParametersTest, AChangeIsInForceFromItsTickOnAndNotBefore) {
  script_ = {{5, kGain, 1.5, 12}, {5, kImages, 7, 20}};
  make()->advance(30);
  for (const auto& [tick, seen] : seen_) {
    EXPECT_EQ(seen.gain, tick < 12 ? 0.5 : 1.5) << "tick " << tick;
    EXPECT_EQ(seen.images, tick < 20 ? 3 : 7) << "tick " << tick;
    EXPECT_EQ(seen.changed, tick == 12 || tick == 20) << "tick " << tick;
  }
  EXPECT_EQ(seen_.size(), 30u);
}

TEST_F(ParametersTest, OneForTheNextTickIsInForceThen) {
  script_ = {{5, kGain, 1.5, 6}};
  make()->advance(10);
  EXPECT_EQ(seen_[5].gain, 0.5);
  EXPECT_EQ(seen_[6].gain, 1.5);
}

TEST_F(ParametersTest, OfSeveralForOneTickTheLastCountsAndTicksNeedNotComeInOrder) {
  script_ = {{3, kGain, 1.8, 15}, {3, kGain, 1.0, 10}, {4, kGain, 1.1, 10}, {4, kGain, 1.2, 10}, {6, kImages, 9, 8}};
  make()->advance(20);
  EXPECT_EQ(seen_[9], (Seen{0.5, 9, false}));
  EXPECT_EQ(seen_[10], (Seen{1.2, 9, true}));
  EXPECT_EQ(seen_[14].gain, 1.2);
  EXPECT_EQ(seen_[15].gain, 1.8);
}

TEST_F(ParametersTest, ASlowComponentTakesItAtItsFirstStepAtOrAfterTheTick) {
  script_ = {{3, kGain, 1.5, 11}, {3, kImages, 7, 15}};
  const auto run = make(5);
  run->advance(22);
  EXPECT_EQ(seen_[10], (Seen{0.5, 3, false}));
  EXPECT_EQ(seen_[15], (Seen{1.5, 7, true}));
  EXPECT_EQ(find(*run, kGain).changed_tick, 15);
}

TEST_F(ParametersTest, WhatItDoesNotAcceptIsRefusedCountedAndChangesNothing) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  script_ = {{1, "control.wave.nothing", 1.0, 4}, {2, kGain, 2.1, 4}, {2, kGain, -0.1, 4}, {3, kImages, 2.5, 4}, {3, kImages, 11, 4}};
  const auto run = make();
  run->advance(10);
  for (const auto& [tick, seen] : seen_) EXPECT_EQ(seen, (Seen{0.5, 3, false})) << "tick " << tick;
  EXPECT_EQ(run->member("control").counters().refused, script_.size());
  msg::Parameter gain = find(*run, kGain);
  EXPECT_EQ(parameter_refusal(gain, 2.1), "control.wave.gain: found 2.1, accepted 0 to 2 1/m");
  EXPECT_EQ(parameter_refusal(find(*run, kImages), 2.5), "control.watch.images: found 2.5, accepted whole numbers from 1 to 10");
  EXPECT_NE(parameter_refusal(gain, kInfinity), "");
  EXPECT_NE(parameter_refusal(gain, std::nan("")), "");
  EXPECT_EQ(parameter_refusal(gain, 0.0), "");
  EXPECT_EQ(parameter_refusal(gain, 2.0), "");
}

TEST_F(ParametersTest, ThoseOfOthersAreNoneOfItsBusiness) {
  script_ = {{1, "navigation.wave.gain", 1.0, 4}, {1, "controller.wave.gain", 1.0, 4}};
  const auto run = make();
  run->advance(10);
  EXPECT_EQ(run->member("control").counters().refused, 0u);
}

TEST_F(ParametersTest, TheListTellsDefaultsWhatIsInForceAndWhatWaits) {
  script_ = {{5, kGain, 1.5, 8}, {5, kGain, 1.7, 30}};
  const auto run = make();
  int lists = 0;
  run->subscribe(topics::kControlParameters, std::function<void(const msg::ParameterList&)>([&](const auto&) { ++lists; }));
  run->advance(5);
  EXPECT_EQ(lists, 1);  // once, at the start
  const msg::Parameter before = find(*run, kGain);
  EXPECT_EQ(before.value, 0.5);
  EXPECT_EQ(before.default_value, 0.5);
  EXPECT_STREQ(before.unit, "1/m");
  EXPECT_EQ(before.changed_tick, -1);
  EXPECT_EQ(before.pending_tick, -1);
  EXPECT_TRUE(std::isnan(before.pending_value));
  run->advance(2);
  EXPECT_EQ(find(*run, kGain).value, 0.5);
  EXPECT_EQ(find(*run, kGain).pending_tick, 8);
  EXPECT_EQ(find(*run, kGain).pending_value, 1.5);
  run->advance(10);
  EXPECT_EQ(find(*run, kGain).value, 1.5);
  EXPECT_EQ(find(*run, kGain).default_value, 0.5);
  EXPECT_EQ(find(*run, kGain).changed_tick, 8);
  EXPECT_EQ(find(*run, kGain).pending_tick, 30);
  EXPECT_EQ(lists, 3);  // one more when the two came, one more when the first was due
}

TEST_F(ParametersTest, AResetBringsTheDefaultsBack) {
  script_ = {{1, kGain, 1.5, 4}, {1, kGain, 1.9, 100}};
  const auto run = make();
  run->advance(10);
  script_.clear();
  run->reset(2);
  seen_.clear();
  run->advance(120);
  for (const auto& [tick, seen] : seen_) EXPECT_EQ(seen, (Seen{0.5, 3, false})) << "tick " << tick;
  EXPECT_EQ(find(*run, kGain).changed_tick, -1);
}

TEST_F(ParametersTest, ACrashAtAnyTickLeavesNoTrace) {
  script_ = {{3, kGain, 1.5, 8}, {4, kImages, 7, 12}, {4, kGain, 0.1, 16}, {9, kGain, 0.2, 10}};
  const auto reference = make();
  reference->advance(25);
  const auto expected = reference->output_hashes();
  const auto expected_seen = seen_;
  for (std::int64_t crash = 1; crash < 20; ++crash) {
    seen_.clear();
    const auto run = make();
    run->advance(crash);
    run->restart("control");
    run->advance(25 - crash);
    EXPECT_EQ(run->output_hashes(), expected) << "crash before tick " << crash;
    for (const auto& [tick, seen] : seen_) {
      EXPECT_EQ(seen.gain, expected_seen.at(tick).gain) << "crash before tick " << crash << ", tick " << tick;
      EXPECT_EQ(seen.images, expected_seen.at(tick).images);
    }
  }
}

TEST_F(ParametersTest, ATableThatCannotBeIsABug) {
  class NoWiring : public Wiring {
   public:
    const InputSlot* input(const TopicInfo&, bool) override { return nullptr; }
    const OutputSlot* output_slot(const TopicInfo&) override { return nullptr; }
    void request_end_of_run() override {}
  } wiring;
  Parameters parameters(wiring, topics::kControlParameters);
  double field = 0.5;
  parameters.add(field, "a", "", {0.0, 1.0}, "");
  EXPECT_THROW(parameters.add(field, "a", "", {0.0, 1.0}, ""), std::logic_error);                     // twice
  EXPECT_THROW(parameters.add(field, "b", "", {0.6, 1.0}, ""), std::logic_error);                     // default out of bounds
  EXPECT_THROW(parameters.add(field, std::string(60, 'x'), "", {0.0, 1.0}, ""), std::logic_error);    // longer than the message's field
  EXPECT_THROW(parameters.add(field, "c", "", {0.0, 1.0}, std::string(96, 'x')), std::logic_error);
}

}  // namespace
}  // namespace constrictor
