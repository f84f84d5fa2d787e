// Changes of run-time parameters at the input layer: who may, which, when.
#include "input/parameter_desk.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "configuration/configuration.hpp"
#include "input/input.hpp"
#include "runtime/local_run.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

constexpr const char* kFrequency = "navigation.travel.frequency_hz";
constexpr const char* kImages = "navigation.watch.images";

void set_name(char (&field)[64], const std::string& name) { std::snprintf(field, sizeof field, "%s", name.c_str()); }

msg::ParameterList announced() {
  msg::ParameterList list{};
  list.count = 2;
  set_name(list.parameters[0].name, kFrequency);
  std::snprintf(list.parameters[0].unit, sizeof list.parameters[0].unit, "Hz");
  list.parameters[0].minimum = 0.05;
  list.parameters[0].maximum = 2.0;
  set_name(list.parameters[1].name, kImages);
  list.parameters[1].is_integer = true;
  list.parameters[1].minimum = 1.0;
  list.parameters[1].maximum = 100.0;
  return list;
}

msg::Request change(const std::string& name, double value, std::int64_t tick, std::uint64_t number = 1,
                    const std::string& source = "pilot", std::uint8_t level = msg::kAuthorityOperator) {
  msg::Request request{};
  std::snprintf(request.source, sizeof request.source, "%s", source.c_str());
  request.level = level;
  request.header.sequence_number = number;
  request.kind = msg::kRequestParameter;
  set_name(request.parameter, name);
  request.parameter_value = value;
  request.effective_tick = tick;
  return request;
}

class ParameterDeskTest : public ::testing::Test {
 protected:
  /// The tick at which it takes effect, or why not.
  std::string rule(const msg::Request& request, std::int64_t now = 100) {
    const auto ruling = ParameterDesk(state_).rule(request, {&list_, nullptr}, now);
    if (const auto* refusal = std::get_if<std::string>(&ruling)) return *refusal;
    const auto& accepted = std::get<msg::ParameterChange>(ruling);
    EXPECT_STREQ(accepted.name, request.parameter);
    EXPECT_STREQ(accepted.source, request.source);
    EXPECT_EQ(accepted.value, request.parameter_value);
    return std::to_string(accepted.effective_tick);
  }
  ParameterDeskState state_;
  msg::ParameterList list_ = announced();
};

TEST_F(ParameterDeskTest, ATickIsNamedOrTheNextOne) {
  EXPECT_EQ(rule(change(kFrequency, 0.9, 0)), "101");
  EXPECT_EQ(rule(change(kFrequency, 0.9, 101)), "101");
  EXPECT_EQ(rule(change(kFrequency, 0.9, 5000)), "5000");
  EXPECT_EQ(rule(change(kFrequency, 0.9, 100)),
            "tick of navigation.travel.frequency_hz: found 100, accepted 101 or later (0: as soon as possible)");
}

TEST_F(ParameterDeskTest, TheRefusalSaysWhatWasFoundAndWhatIsAccepted) {
  EXPECT_EQ(rule(change(kFrequency, 2.5, 0)), "navigation.travel.frequency_hz: found 2.5, accepted 0.05 to 2 Hz");
  EXPECT_EQ(rule(change(kImages, 2.5, 0)), "navigation.watch.images: found 2.5, accepted whole numbers from 1 to 100");
  EXPECT_NE(rule(change(kImages, std::nan(""), 0)).find("accepted whole numbers"), std::string::npos);
  EXPECT_NE(rule(change("navigation.travel", 1, 0)).find("found 'navigation.travel', accepted one that its component announces"), std::string::npos);
  EXPECT_NE(rule(change("\033[2J", 1, 0)).find("found '?'"), std::string::npos);  // it goes to people's terminals
}

TEST_F(ParameterDeskTest, WhatWaitsIsBoundedButTheNextTickIsAlwaysFree) {
  for (int i = 0; i < msg::kMaxParameterChanges; ++i) EXPECT_EQ(rule(change(kFrequency, 0.9, 200 + i)), std::to_string(200 + i));
  EXPECT_NE(rule(change(kFrequency, 0.9, 1000)).find("256 changes wait"), std::string::npos);
  EXPECT_EQ(rule(change(kFrequency, 0.9, 0)), "101");
  EXPECT_EQ(rule(change(kFrequency, 0.9, 1000), 200), "1000");  // one was due
}

/// Announces as navigation does.
class Announcer : public StatefulComponent<int> {
 public:
  explicit Announcer(Wiring& wiring) : out_(wiring.output(topics::kNavigationParameters)) {}
  void step(const Tick& tick) override {
    if (tick.index == 0) out_.write(announced());
  }

 private:
  Output<msg::ParameterList> out_;
};

class IdlePlant : public Plant {
 public:
  void sample(const Tick&) override {}
  void step(const Tick&) override {}
  [[nodiscard]] std::int64_t period_ns() const override { return 20'000'000; }
};

class InputParameters : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& text) const {
    std::ofstream(dir_ / "input.yaml") << text;
    return dir_ / "input.yaml";
  }
  void run(std::int64_t ticks, std::map<std::int64_t, std::vector<msg::Request>> asked, const std::string& configuration = "parameter_changes: []") {
    auto outside = std::make_shared<OutsideRequests>();
    LocalRun local({{"physics", [](Wiring&, const constrictor::Setup&) { return std::make_unique<IdlePlant>(); }},
                    {"navigation", [](Wiring& wiring, const constrictor::Setup&) { return std::make_unique<Announcer>(wiring); }},
                    make_input_factory(outside)},
                   constrictor::Setup{}, {{"input", file(configuration)}});
    local.subscribe(topics::kParameterChange, std::function<void(const msg::ParameterChange&)>([&](const auto& c) { changes_.push_back(c); }));
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      for (const auto& request : asked[tick]) outside->add(request);
      local.advance(1);
    }
    authority_ = *local.latest(topics::kAuthority);
  }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
  std::vector<msg::ParameterChange> changes_;
  msg::Authority authority_{};
};

TEST_F(InputParameters, SettingTakesNoAuthorityAndIsAnswered) {
  run(10, {{5, {change(kFrequency, 0.9, 0)}}});
  ASSERT_EQ(changes_.size(), 1u);
  EXPECT_EQ(changes_[0].effective_tick, 6);
  EXPECT_EQ(changes_[0].header.tick, 5);
  EXPECT_EQ(authority_.level, msg::kAuthorityNone);
  EXPECT_STREQ(authority_.ruled_source, "pilot");
  EXPECT_EQ(authority_.refused_count, 0u);
}

TEST_F(InputParameters, NobodyOfALowerLevelThanTheHolderMaySet) {
  msg::Request take = change("", 0, 0);
  take.kind = msg::kRequestTake;
  run(20, {{3, {take}},
           {5, {change(kFrequency, 0.9, 0, 1, "machine", msg::kAuthorityExternal)}},
           {7, {change(kFrequency, 1.1, 0, 1, "tuner", msg::kAuthorityOperator)}}});
  ASSERT_EQ(changes_.size(), 1u);
  EXPECT_STREQ(changes_[0].source, "tuner");
  EXPECT_STREQ(authority_.refusal, "machine: authority is with pilot, of a higher level");
  EXPECT_STREQ(authority_.source, "pilot");
}

TEST_F(InputParameters, AStoppedRobotMayBeTuned) {
  msg::Request stop = change("", 0, 0);
  stop.kind = msg::kRequestEmergencyStop;
  run(20, {{3, {stop}}, {5, {change(kFrequency, 0.9, 0, 2)}}});
  EXPECT_EQ(changes_.size(), 1u);
  EXPECT_TRUE(authority_.emergency_stop);
}

TEST_F(InputParameters, MoreThanATickHoldsAreRefused) {
  std::vector<msg::Request> many;
  for (std::uint64_t i = 1; i <= 10; ++i) many.push_back(change(kImages, static_cast<double>(i), 50, i));
  run(10, {{5, many}});
  EXPECT_EQ(changes_.size(), 8u);
  EXPECT_EQ(authority_.refused_count, 2u);
}

TEST_F(InputParameters, PlannedChangesAreWrittenOneTickBeforeTheirsInTheOrderOfTheFile) {
  run(40, {},
      "parameter_changes:\n"
      "  - {tick: 30, name: navigation.travel.frequency_hz, value: 0.9}\n"
      "  - {tick: 12, name: navigation.watch.images, value: 7}\n"
      "  - {tick: 30, name: navigation.travel.frequency_hz, value: 1.1}\n"
      "  - {tick: 35, name: navigation.travel.nothing, value: 1.1}\n");
  ASSERT_EQ(changes_.size(), 3u);
  EXPECT_EQ(changes_[0].effective_tick, 12);
  EXPECT_EQ(changes_[0].header.tick, 11);
  EXPECT_EQ(changes_[1].value, 0.9);
  EXPECT_EQ(changes_[2].value, 1.1);
  EXPECT_EQ(changes_[2].effective_tick, 30);
  EXPECT_EQ(authority_.refused_count, 1u);
  EXPECT_STREQ(authority_.refused_source, "input.yaml");
}

TEST_F(InputParameters, AFileThatCannotBeIsRefused) {
  EXPECT_THROW(load_planned_changes(file("parameter_changes: [{tick: 5, name: a, value: 1}]")), ConfigurationError);
  EXPECT_THROW(load_planned_changes(file("parameter_changes: [{tick: 50, name: a}]")), ConfigurationError);
  EXPECT_THROW(load_planned_changes(file("changes: []")), ConfigurationError);
  std::string many = "parameter_changes:\n";
  for (int i = 0; i < 8; ++i) many += "  - {tick: 50, name: a, value: 1}\n";
  EXPECT_EQ(load_planned_changes(file(many)).size(), 8u);
  EXPECT_THROW(load_planned_changes(file(many + "  - {tick: 50, name: a, value: 1}\n")), ConfigurationError);
}

}  // namespace
}  // namespace constrictor
