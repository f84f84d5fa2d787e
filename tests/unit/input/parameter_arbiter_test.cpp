// Changes of run-time parameters: which are accepted, from which source, and at which tick.
#include "input/parameter_arbiter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "barrier/local_run.hpp"
#include "configuration/configuration.hpp"
#include "input/input.hpp"
#include "support/scripted_members.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

constexpr const char* kFrequency = "navigation.travel.speed_m_s";
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

class ParameterArbiterTest : public ::testing::Test {
 protected:
  /// The tick at which the change takes effect, or the reason of its refusal.
  std::string decide(const msg::Request& request, std::int64_t now = 100) {
    const auto decision = ParameterArbiter(state_).decide(request, {&list_, nullptr}, now);
    if (const auto* refusal = std::get_if<std::string>(&decision)) return *refusal;
    const auto& accepted = std::get<msg::ParameterChange>(decision);
    EXPECT_STREQ(accepted.name, request.parameter);
    EXPECT_STREQ(accepted.source, request.source);
    EXPECT_EQ(accepted.value, request.parameter_value);
    return std::to_string(accepted.effective_tick);
  }
  ParameterArbiterState state_;
  msg::ParameterList list_ = announced();
};

TEST_F(ParameterArbiterTest, TheTickIsTheRequestedOneOrTheNext) {
  EXPECT_EQ(decide(change(kFrequency, 0.9, 0)), "101");
  EXPECT_EQ(decide(change(kFrequency, 0.9, 101)), "101");
  EXPECT_EQ(decide(change(kFrequency, 0.9, 5000)), "5000");
  EXPECT_EQ(decide(change(kFrequency, 0.9, 100)),
            "tick of navigation.travel.speed_m_s: found 100, accepted 101 or later (0: as soon as possible)");
}

TEST_F(ParameterArbiterTest, ARefusalNamesTheFoundAndTheAcceptedValues) {
  EXPECT_EQ(decide(change(kFrequency, 2.5, 0)), "navigation.travel.speed_m_s: found 2.5, accepted 0.05 to 2 Hz");
  EXPECT_EQ(decide(change(kImages, 2.5, 0)),
            "navigation.watch.images: found 2.5, accepted whole numbers from 1 to 100");
  EXPECT_NE(decide(change(kImages, std::nan(""), 0)).find("accepted whole numbers"), std::string::npos);
  EXPECT_EQ(decide(change("navigation.travel", 1, 0)).find("no component announces a parameter 'navigation.travel'"),
            0u);
  EXPECT_NE(decide(change("\033[2J", 1, 0)).find("parameter '?'"), std::string::npos);  // people read it on terminals
}

TEST_F(ParameterArbiterTest, TheNumberOfWaitingChangesIsBoundedAndTheNextTickAlwaysFree) {
  for (int i = 0; i < msg::kMaxParameterChanges; ++i)
    EXPECT_EQ(decide(change(kFrequency, 0.9, 200 + i)), std::to_string(200 + i));
  EXPECT_NE(decide(change(kFrequency, 0.9, 1000)).find("256 changes wait"), std::string::npos);
  EXPECT_EQ(decide(change(kFrequency, 0.9, 0)), "101");
  EXPECT_EQ(decide(change(kFrequency, 0.9, 1000), 200), "1000");  // the tick of one change has come
}

/// Announces parameters as navigation does.
ComponentFactory announcer() {
  return testing::scripted_writer<msg::ParameterList>("navigation", topics::kNavigationParameters,
                                                      [](const Tick& tick, const auto& out) {
                                                        if (tick.index == 0) out.write(announced());
                                                      });
}

class InputParameters : public ::testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file(const std::string& text) const {
    std::ofstream(dir_ / "input.yaml") << text;
    return dir_ / "input.yaml";
  }
  void run(std::int64_t ticks, std::map<std::int64_t, std::vector<msg::Request>> asked,
           const std::string& configuration = "parameter_changes: []") {
    auto clients = std::make_shared<ClientRequests>();
    LocalRun local({testing::idle_plant(), announcer(), make_input_factory(clients)}, constrictor::Setup{},
                   {{"input", file(configuration)}});
    local.subscribe(topics::kParameterChange,
                    std::function<void(const msg::ParameterChange&)>([&](const auto& c) { changes_.push_back(c); }));
    for (std::int64_t tick = 0; tick < ticks; ++tick) {
      for (const auto& request : asked[tick]) clients->add(request);
      local.advance(1);
    }
    authority_ = *local.latest(topics::kAuthority);
  }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path dir_ = folder_.path();
  std::vector<msg::ParameterChange> changes_;
  msg::Authority authority_{};
};

TEST_F(InputParameters, AChangeTakesNoAuthorityAndIsAnswered) {
  run(10, {{5, {change(kFrequency, 0.9, 0)}}});
  ASSERT_EQ(changes_.size(), 1u);
  EXPECT_EQ(changes_[0].effective_tick, 6);
  EXPECT_EQ(changes_[0].header.tick, 5);
  EXPECT_EQ(authority_.level, msg::kAuthorityNone);
  EXPECT_STREQ(authority_.answered_source, "pilot");
  EXPECT_EQ(authority_.refused_count, 0u);
}

TEST_F(InputParameters, RefusesASourceOfALowerLevelThanTheHolder) {
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

TEST_F(InputParameters, ParametersMayChangeDuringAnEmergencyStop) {
  msg::Request stop = change("", 0, 0);
  stop.kind = msg::kRequestEmergencyStop;
  run(20, {{3, {stop}}, {5, {change(kFrequency, 0.9, 0, 2)}}});
  EXPECT_EQ(changes_.size(), 1u);
  EXPECT_TRUE(authority_.emergency_stop);
}

TEST_F(InputParameters, RefusesMoreChangesThanATickHolds) {
  std::vector<msg::Request> many;
  for (std::uint64_t i = 1; i <= 10; ++i) many.push_back(change(kImages, static_cast<double>(i), 50, i));
  run(10, {{5, many}});
  EXPECT_EQ(changes_.size(), 8u);
  EXPECT_EQ(authority_.refused_count, 2u);
}

TEST_F(InputParameters, WritesPlannedChangesOneTickBeforeTheirOwnInTheOrderOfTheFile) {
  run(40, {},
      "parameter_changes:\n"
      "  - {tick: 30, name: navigation.travel.speed_m_s, value: 0.9}\n"
      "  - {tick: 12, name: navigation.watch.images, value: 7}\n"
      "  - {tick: 30, name: navigation.travel.speed_m_s, value: 1.1}\n"
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

TEST_F(InputParameters, RejectsAFileWithImpossibleChanges) {
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
