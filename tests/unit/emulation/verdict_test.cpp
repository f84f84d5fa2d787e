#include "sim/emulation/verdict.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "constrictor/messages.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "support/project.hpp"

namespace constrictor::emulation {
namespace {

nlohmann::json verdict(const Scenario& scenario, const std::vector<std::uint8_t>& sequence) {
  return nlohmann::json::parse(
      verdict_json({load_robot(testing::robot_path("mamba")), scenario}, sequence, 500'000'000));
}

TEST(Verdict, ReadsTheMissionOfAScenario) {
  EXPECT_EQ(mission_sequence(testing::source_path("sim/scenarios/case_study.yaml")),
            (std::vector<std::uint8_t>{msg::kColourGreen, msg::kColourRed}));
  EXPECT_TRUE(mission_sequence(testing::source_path("sim/scenarios/line.yaml")).empty());
}

TEST(Verdict, EachObjectOfTheMissionMustLieInAZoneOfItsColour) {
  Scenario scenario = load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), 1);
  const std::vector<std::uint8_t> sequence = {msg::kColourGreen, msg::kColourRed};
  const auto at_start = verdict(scenario, sequence);
  EXPECT_FALSE(at_start["success"].get<bool>());
  EXPECT_NE(at_start["reason"].get<std::string>().find("green: found 0"), std::string::npos);
  EXPECT_DOUBLE_EQ(at_start["left_out_s"].get<double>(), 0.5);
  const auto put = [&](std::uint8_t colour, std::uint8_t zone_colour, double beside_m) {
    for (auto& object : scenario.objects) {
      for (const auto& zone : scenario.zones) {
        if (object.colour == colour && zone.colour == zone_colour)
          object.position_m = zone.position_m + Eigen::Vector2d(beside_m * zone.radius_m, 0.0);
      }
    }
  };
  put(msg::kColourGreen, msg::kColourGreen, 0.9);
  put(msg::kColourRed, msg::kColourRed, 1.1);
  const auto half = verdict(scenario, sequence);
  EXPECT_FALSE(half["success"].get<bool>());
  EXPECT_EQ(half["reason"].get<std::string>().find("green"), std::string::npos);
  EXPECT_NE(half["reason"].get<std::string>().find("red: found 0"), std::string::npos);
  put(msg::kColourRed, msg::kColourRed, 0.5);
  EXPECT_TRUE(verdict(scenario, sequence)["success"].get<bool>());
  put(msg::kColourRed, msg::kColourGreen, 0.2);
  EXPECT_FALSE(verdict(scenario, sequence)["success"].get<bool>()) << "the zone of another colour";
}

TEST(Verdict, WithoutObjectsTheHeadMustBeAtTheEndOfTheLine) {
  Scenario scenario = load_scenario(testing::source_path("sim/scenarios/line.yaml"), 1);
  EXPECT_FALSE(verdict(scenario, {})["success"].get<bool>());
  scenario.start_m = scenario.line_m.back();
  EXPECT_TRUE(verdict(scenario, {})["success"].get<bool>());
}

}  // namespace
}  // namespace constrictor::emulation
