// Run-time parameters in a run: each change comes into force at its tick, independently of the order of arrival and of
// a restart.
#include "component/parameters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

#include "barrier/local_run.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

constexpr const char* kGain = "control.wave.gain";
constexpr const char* kImages = "control.watch.images";
constexpr const char* kColour = "control.watch.colour";

struct Asked {
  std::int64_t at;  ///< tick of the step that writes the change
  std::string name;
  double value;
  std::int64_t effective_tick;
};

/// Stands for the component `input`: writes the changes of a list, each at its tick.
ComponentFactory scripted_input(const std::vector<Asked>& script) {
  return testing::scripted_writer<msg::ParameterChange>(
      "input", topics::kParameterChange, [&script](const Tick& tick, const auto& out) {
        for (const auto& asked : script) {
          if (asked.at != tick.index) continue;
          msg::ParameterChange change{};
          std::snprintf(change.name, sizeof change.name, "%s", asked.name.c_str());
          change.value = asked.value;
          change.effective_tick = asked.effective_tick;
          out.write(change);
        }
      });
}

/// The values in one step.
struct Seen {
  double gain = 0.0;
  int images = 0;
  bool changed = false;
  bool operator==(const Seen&) const = default;
};

struct OwnerState {
  ParameterState parameters;
  double sum = 0.0;  ///< depends on the values in every step
  template <class Archive>
  void serialize(Archive& archive) {
    archive(parameters, sum);
  }
};

struct OwnerConfig : ParameterSet {
  double gain = add(gain, "wave.gain", 0.5, "1/m", {0.0, 2.0}, Changes::kWhileRunning, "a gain");
  int images = add(images, "watch.images", 3, "", {1, 10}, Changes::kWhileRunning, "a number of images");
  std::uint8_t colour = add(colour, "watch.colour", 1, {"red", "green", "blue"}, Changes::kWhileRunning, "a colour");
  double fixed = add(fixed, "watch.fixed", 1.0, "", {0.0, 2.0}, Changes::kAtStart, "a number for the start only");
};

class Owner : public StatefulComponent<OwnerState> {
 public:
  Owner(Wiring& wiring, std::uint16_t period, std::map<std::int64_t, Seen>& seen)
      : parameters_(wiring, topics::kControlParameters, config_),
        period_(period),
        seen_(seen),
        out_(wiring.output(topics::kMotionStatus)) {}
  [[nodiscard]] Timing timing() const override { return {period_, 1}; }
  void step(const Tick& tick) override {
    const bool changed = parameters_.step(tick, state_.parameters);
    seen_[tick.index] = {config_.gain, config_.images, changed};
    state_.sum = std::fmod(1.7 * state_.sum + config_.gain * config_.images, 1000.0);
    msg::MotionStatus status{};
    status.phase_rad = state_.sum;
    out_.write(status);
  }

 private:
  OwnerConfig config_;
  Parameters parameters_;
  std::uint16_t period_;
  std::map<std::int64_t, Seen>& seen_;
  Output<msg::MotionStatus> out_;
};

class ParametersTest : public ::testing::Test {
 protected:
  std::unique_ptr<LocalRun> make(std::uint16_t period = 1) {
    return std::make_unique<LocalRun>(
        std::vector<ComponentFactory>{testing::idle_plant(),
                                      scripted_input(script_),
                                      {"control",
                                       [this, period](Wiring& w, const constrictor::Setup&) {
                                         return std::make_unique<Owner>(w, period, seen_);
                                       }}},
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

TEST_F(ParametersTest, ChangeIsInForceFromItsTickOnAndNotBefore) {
  script_ = {{5, kGain, 1.5, 12}, {5, kImages, 7, 20}};
  make()->advance(30);
  for (const auto& [tick, seen] : seen_) {
    EXPECT_EQ(seen.gain, tick < 12 ? 0.5 : 1.5) << "tick " << tick;
    EXPECT_EQ(seen.images, tick < 20 ? 3 : 7) << "tick " << tick;
    EXPECT_EQ(seen.changed, tick == 12 || tick == 20) << "tick " << tick;
  }
  EXPECT_EQ(seen_.size(), 30u);
}

TEST_F(ParametersTest, ChangeForTheNextTickIsInForceThen) {
  script_ = {{5, kGain, 1.5, 6}};
  make()->advance(10);
  EXPECT_EQ(seen_[5].gain, 0.5);
  EXPECT_EQ(seen_[6].gain, 1.5);
}

TEST_F(ParametersTest, LastChangeForATickCountsAndTicksMayArriveInAnyOrder) {
  script_ = {{3, kGain, 1.8, 15}, {3, kGain, 1.0, 10}, {4, kGain, 1.1, 10}, {4, kGain, 1.2, 10}, {6, kImages, 9, 8}};
  make()->advance(20);
  EXPECT_EQ(seen_[9], (Seen{0.5, 9, false}));
  EXPECT_EQ(seen_[10], (Seen{1.2, 9, true}));
  EXPECT_EQ(seen_[14].gain, 1.2);
  EXPECT_EQ(seen_[15].gain, 1.8);
}

TEST_F(ParametersTest, SlowComponentAppliesItInItsFirstStepAtOrAfterTheTick) {
  script_ = {{3, kGain, 1.5, 11}, {3, kImages, 7, 15}};
  const auto run = make(5);
  run->advance(22);
  EXPECT_EQ(seen_[10], (Seen{0.5, 3, false}));
  EXPECT_EQ(seen_[15], (Seen{1.5, 7, true}));
  EXPECT_EQ(find(*run, kGain).changed_tick, 15);
}

TEST_F(ParametersTest, RejectedChangesAreCountedAndChangeNothing) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  script_ = {{1, "control.wave.nothing", 1.0, 4},
             {2, kGain, 2.1, 4},
             {2, kGain, -0.1, 4},
             {3, kImages, 2.5, 4},
             {3, kImages, 11, 4}};
  const auto run = make();
  run->advance(10);
  for (const auto& [tick, seen] : seen_) EXPECT_EQ(seen, (Seen{0.5, 3, false})) << "tick " << tick;
  EXPECT_EQ(run->member("control").counters().refused, script_.size());
  msg::Parameter gain = find(*run, kGain);
  EXPECT_EQ(parameter_refusal(gain, 2.1), "control.wave.gain: found 2.1, accepted 0 to 2 1/m");
  EXPECT_EQ(parameter_refusal(find(*run, kImages), 2.5),
            "control.watch.images: found 2.5, accepted whole numbers from 1 to 10");
  EXPECT_NE(parameter_refusal(gain, kInfinity), "");
  EXPECT_NE(parameter_refusal(gain, std::nan("")), "");
  EXPECT_EQ(parameter_refusal(gain, 0.0), "");
  EXPECT_EQ(parameter_refusal(gain, 2.0), "");
}

TEST_F(ParametersTest, ChangesOfOtherComponentsAreIgnored) {
  script_ = {{1, "navigation.wave.gain", 1.0, 4}, {1, "controller.wave.gain", 1.0, 4}};
  const auto run = make();
  run->advance(10);
  EXPECT_EQ(run->member("control").counters().refused, 0u);
}

TEST_F(ParametersTest, ListHasDefaultsValuesInForceAndWaitingChanges) {
  script_ = {{5, kGain, 1.5, 8}, {5, kGain, 1.7, 30}};
  const auto run = make();
  int lists = 0;
  run->subscribe(topics::kControlParameters,
                 std::function<void(const msg::ParameterList&)>([&](const auto&) { ++lists; }));
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

TEST_F(ParametersTest, ListHasOnlyParametersThatMayChangeDuringARun) {
  const auto run = make();
  run->advance(1);
  const auto* list = run->latest(topics::kControlParameters);
  ASSERT_NE(list, nullptr);
  ASSERT_EQ(list->count, 3);
  EXPECT_STREQ(list->parameters[0].name, kColour);
  EXPECT_STREQ(list->parameters[1].name, kImages);
  EXPECT_STREQ(list->parameters[2].name, kGain);
  EXPECT_STREQ(list->parameters[2].doc, "a gain");
  EXPECT_TRUE(list->parameters[1].is_integer);
  EXPECT_EQ(list->parameters[1].maximum, 10.0);
  EXPECT_TRUE(choices_of(list->parameters[1]).empty());
}

TEST_F(ParametersTest, AParameterIsChosenByName) {
  script_ = {{1, kColour, 2, 4}, {2, kColour, 3, 5}, {2, kColour, 0.5, 6}};
  const auto run = make();
  run->advance(3);
  EXPECT_EQ(find(*run, kColour).value, 1.0);
  EXPECT_EQ(choices_of(find(*run, kColour)), (std::vector<std::string>{"red", "green", "blue"}));
  run->advance(10);
  EXPECT_EQ(find(*run, kColour).value, 2.0) << "numbers without a name are refused";
  EXPECT_EQ(parameter_refusal(find(*run, kColour), 3.0),
            "control.watch.colour: found 3, accepted the number of one of red, green, blue (from 0)");
}

TEST_F(ParametersTest, ResetRestoresTheDefaults) {
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

TEST_F(ParametersTest, RestartAtAnyTickChangesNothing) {
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

TEST_F(ParametersTest, RowThatContradictsItselfIsABug) {
  class NoWiring : public Wiring {
   public:
    const InputSlot* input(const TopicInfo&, bool) override { return nullptr; }
    const OutputSlot* output_slot(const TopicInfo&) override { return nullptr; }
    void request_end_of_run() override {}
  } wiring;
  Parameters parameters(wiring, topics::kControlParameters);
  double field = 0.5;
  parameters.add(field, "a", "", {0.0, 1.0}, "");
  EXPECT_THROW(parameters.add(field, "a", "", {0.0, 1.0}, ""), std::logic_error);  // twice
  EXPECT_THROW(parameters.add(field, "b", "", {0.6, 1.0}, ""), std::logic_error);  // default out of bounds
  EXPECT_THROW(parameters.add(field, std::string(60, 'x'), "", {0.0, 1.0}, ""),
               std::logic_error);  // longer than the message's field
  EXPECT_THROW(parameters.add(field, "c", "", {0.0, 1.0}, std::string(96, 'x')), std::logic_error);
}

}  // namespace
}  // namespace constrictor
