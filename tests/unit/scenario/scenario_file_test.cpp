#include "sim/scenario/scenario_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace constrictor {
namespace {

const std::filesystem::path kScenarios = SCENARIO_DIR;
const std::string kMinimal = "name: x\nstart: {position_m: [0, 0]}\n";

Scenario read(const std::string& text, std::uint64_t seed = 1) {
  return read_scenario(Configuration::parse(text, "x.yaml"), seed);
}

std::string error_of(const std::string& text) {
  try {
    (void)read(text);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return {};
}

TEST(ScenarioFile, TheSmallestScenarioIsARobotOnAPlane) {
  const Scenario scenario = read(kMinimal);
  EXPECT_TRUE(scenario.line_m.empty());
  EXPECT_TRUE(scenario.objects.empty());
  EXPECT_TRUE(scenario.sensor_noise);
}

TEST(ScenarioFile, EveryFileOfTheProjectIsSoundForManySeeds) {
  for (const auto& entry : std::filesystem::directory_iterator(kScenarios)) {
    if (entry.path().extension() != ".yaml") continue;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      EXPECT_NO_THROW((void)load_scenario(entry.path(), seed)) << entry.path() << " seed " << seed;
    }
  }
}

TEST(ScenarioFile, TheCaseStudyHasWhatThePaperHas) {
  const Scenario scenario = load_scenario(kScenarios / "case_study.yaml", 3);
  ASSERT_EQ(scenario.objects.size(), 2U);
  ASSERT_EQ(scenario.zones.size(), 2U);
  EXPECT_EQ(scenario.objects[0].colour, 1);
  EXPECT_EQ(scenario.objects[1].colour, 2);
  // Objects beyond the line's end, zones on the initial side.
  const Eigen::Vector2d begin = scenario.line_m.front();
  const Eigen::Vector2d end = scenario.line_m.back();
  for (const ScenarioObject& object : scenario.objects) {
    EXPECT_LT((object.position_m - end).norm(), (object.position_m - begin).norm());
  }
  for (const ScenarioZone& zone : scenario.zones) EXPECT_LT((zone.position_m - begin).norm(), 1.5);
}

TEST(ScenarioFile, LinesOfTheCaseStudyHaveThePromisedLengthAndRadius) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scenario scenario = load_scenario(kScenarios / "case_study.yaml", seed);
    double length = 0.0;
    for (std::size_t i = 1; i < scenario.line_m.size(); ++i) {
      length += (scenario.line_m[i] - scenario.line_m[i - 1]).norm();
      if (i < 2) continue;
      // Circle through three points: curvature = 4 area / product of the sides.
      const Eigen::Vector2d a = scenario.line_m[i - 2];
      const Eigen::Vector2d b = scenario.line_m[i - 1];
      const Eigen::Vector2d c = scenario.line_m[i];
      const double twice_area = std::abs((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x());
      const double curvature = 2 * twice_area / ((b - a).norm() * (c - b).norm() * (c - a).norm());
      EXPECT_LT(curvature, 1.0);
    }
    EXPECT_GT(length, 3.8);
    EXPECT_LT(length, 5.2);
  }
}

TEST(ScenarioFile, EqualSeedsGiveEqualScenes) {
  const Scenario a = load_scenario(kScenarios / "case_study.yaml", 7);
  const Scenario b = load_scenario(kScenarios / "case_study.yaml", 7);
  EXPECT_EQ(a.line_m, b.line_m);
  EXPECT_EQ(a.objects[0].position_m, b.objects[0].position_m);
  EXPECT_EQ(a.objects[1].mass_kg, b.objects[1].mass_kg);
  EXPECT_EQ(a.light.direction, b.light.direction);
  EXPECT_EQ(a.start_yaw_rad, b.start_yaw_rad);
}

TEST(ScenarioFile, TheSeedVariesEveryAspectWithinItsRange) {
  std::set<int> object_sides;
  std::set<int> zone_sides;
  std::set<int> line_sides;
  std::set<double> masses;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    const Scenario scenario = load_scenario(kScenarios / "case_study.yaml", seed);
    const Eigen::Vector2d ahead = (scenario.line_m.back() - *(scenario.line_m.end() - 3)).normalized();
    const auto side_of = [&](const ScenarioObject& object) {
      const Eigen::Vector2d d = object.position_m - scenario.line_m.back();
      return ahead.x() * d.y() - ahead.y() * d.x() > 0 ? 1 : 0;
    };
    object_sides.insert(2 * side_of(scenario.objects[0]) + side_of(scenario.objects[1]));
    zone_sides.insert(scenario.zones[0].position_m.y() > scenario.zones[1].position_m.y() ? 1 : 0);
    line_sides.insert(scenario.line_m[80].y() > 0 ? 1 : 0);
    masses.insert(scenario.objects[0].mass_kg);
    EXPECT_GE(scenario.objects[0].mass_kg, 0.4 * 0.6);
    EXPECT_LE(scenario.objects[0].mass_kg, 0.4 * 1.4);
    EXPECT_GE(scenario.friction.ground_scale, 0.8);
    EXPECT_LE(scenario.friction.ground_scale, 1.2);
    EXPECT_LE(std::abs(scenario.start_yaw_rad), 0.1);
    EXPECT_NEAR(scenario.light.direction.norm(), 1.0, 1e-12);
    EXPECT_LE(scenario.camera_noise_sd, 0.015);
  }
  EXPECT_EQ(object_sides.size(), 4U);
  EXPECT_EQ(zone_sides.size(), 2U);
  EXPECT_EQ(line_sides.size(), 2U);
  EXPECT_EQ(masses.size(), 60U);
}

TEST(ScenarioFile, ReadsObstaclesAndPerturbations) {
  const Scenario scenario = read(kMinimal +
                                 "objects:\n- {colour: red, shape: box, size_m: [0.1, 0.2, 0.3], mass_kg: 1, position_m: [1, 0]}\n"
                                 "obstacles:\n- {shape: box, size_m: [4, 0.1, 0.3], position_m: [0, 2], yaw_rad: 0.3}\n"
                                 "- {radius_m: 0.03, height_m: 0.2, position_m: [0, -1]}\n"
                                 "perturbations:\n- {object: 0, when_displaced_m: 0.5, duration_s: 2, force_n: [0, 20, 0]}\n"
                                 "noise: {sensors: false}\n");
  ASSERT_EQ(scenario.obstacles.size(), 2U);
  EXPECT_EQ(scenario.obstacles[1].shape, BodyShape::kCylinder);
  EXPECT_EQ(scenario.objects[0].shape, BodyShape::kBox);
  ASSERT_EQ(scenario.perturbations.size(), 1U);
  EXPECT_TRUE(std::isnan(scenario.perturbations[0].at_s));
  EXPECT_EQ(scenario.perturbations[0].displaced_m, 0.5);
  EXPECT_FALSE(scenario.sensor_noise);
}

TEST(ScenarioFile, NamesWhatIsWrong) {
  const std::string object = "objects:\n- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [1, 0]}\n";
  EXPECT_EQ(error_of(kMinimal + "objects:\n- {colour: pink, radius_m: 0.1}\n"),
            "x.yaml:4: objects[0].colour: found pink, accepted one of green, red, blue, yellow");
  EXPECT_EQ(error_of(kMinimal + object + "- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [1.1, 0]}\n"),
            "x.yaml:3: objects: found that objects[1] overlaps objects[0], accepted bodies apart");
  EXPECT_EQ(error_of(kMinimal + object + "perturbations:\n- {object: 1}\n"),
            "x.yaml:6: perturbations[0].object: found 1, accepted a whole number 0 to 0");
  EXPECT_EQ(error_of(kMinimal + object + "perturbations:\n- {object: 0, duration_s: 1}\n"),
            "x.yaml:6: perturbations[0].at_s: found both or neither of at_s and when_displaced_m, accepted one of them");
  EXPECT_EQ(error_of(kMinimal + "line: {colour: blue, width_m: 0.05, begin_m: [0, 0], segments: []}\n"),
            "x.yaml:3: line.segments: found a list of 0, accepted a list of 1 to 64 maps");
  EXPECT_EQ(error_of("name: x\n"), "x.yaml:1: start: found nothing, accepted a map");
  EXPECT_EQ(error_of(kMinimal + "light: {direction: [0, 1, 0]}\n"),
            "x.yaml:3: light.direction: found a light at or below the horizon, accepted a third number above 0.05");
  EXPECT_EQ(error_of(kMinimal + "objects:\n- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [-1, 0]}\n"),
            "x.yaml:3: objects: found that objects[0] overlaps the robot's body at the start, accepted bodies apart");
}

TEST(ScenarioFile, RedrawsAVariationThatOverlaps) {
  // Half of all draws put the object on the robot's body; every seed still gives a sound scene.
  const std::string text = kMinimal +
                           "objects:\n- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [-1, 0.2]}\n"
                           "variation: {object_position_m: 0.2}\n";
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    EXPECT_GT(std::abs(read(text, seed).objects[0].position_m.y()), 0.159);
  }
}

}  // namespace
}  // namespace constrictor
