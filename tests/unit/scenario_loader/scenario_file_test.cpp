#include "sim/scenario_loader/scenario_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

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

TEST(ScenarioFile, ASlopeTiltsGravityRelativeToTheGround) {
  EXPECT_EQ(read(kMinimal).gravity_m_s2, Eigen::Vector3d(0.0, 0.0, -9.81));
  const Eigen::Vector3d gravity = read(kMinimal + "slope: {grade: 0.05, uphill_rad: 0.5}\n").gravity_m_s2;
  EXPECT_NEAR(gravity.norm(), 9.81, 1e-12);
  const double horizontal = gravity.head<2>().norm();
  EXPECT_NEAR(horizontal / -gravity.z(), 0.05, 1e-12) << "rise by distance";
  EXPECT_NEAR(std::atan2(-gravity.y(), -gravity.x()), 0.5, 1e-12) << "gravity pulls downhill";
  EXPECT_NE(error_of(kMinimal + "slope: {grade: 0.3}\n").find("grade"), std::string::npos);
  EXPECT_NE(error_of(kMinimal + "slope: {angle: 0.1}\n").find("angle"), std::string::npos);
}

TEST(ScenarioFile, TheGroundMayBeGlossy) {
  EXPECT_EQ(read(kMinimal).ground_gloss, 0.0);
  EXPECT_EQ(read(kMinimal + "ground_gloss: 1.5\n").ground_gloss, 1.5);
  EXPECT_NE(error_of(kMinimal + "ground_gloss: 4.5\n").find("ground_gloss"), std::string::npos);
  EXPECT_NE(error_of(kMinimal + "ground_gloss: -0.1\n").find("ground_gloss"), std::string::npos);
}

TEST(ScenarioFile, WhatLiesOnTheGroundHasAnotherTint) {
  const std::string mission =
      "mission: {sequence: [green], line_colour: blue}\n"
      "line: {colour: blue, width_m: 0.05, begin_m: [1, 0], segments: [{length_m: 2}]}\n"
      "objects: [{colour: green, position_m: [4, 0], radius_m: 0.08, height_m: 0.15, mass_kg: 0.4}]\n"
      "zones: [{colour: green, position_m: [0, 2], radius_m: 0.3}, {colour: red, position_m: [0, 4], radius_m: 0.3}]\n";
  EXPECT_NO_THROW((void)read(kMinimal + mission + "ground_colour: [0.10, 0.30, 0.10]\n"));
  EXPECT_NO_THROW((void)read(kMinimal + mission + "ground_colour: [0.62, 0.03, 0.03]\n")) << "no red zone is needed";
  EXPECT_NO_THROW((void)read(kMinimal + "ground_colour: [0.04, 0.50, 0.09]\n")) << "there is no mission";
  // Half as bright, a green paint has the same hue and saturation.
  const std::string zone = error_of(kMinimal + mission + "ground_colour: [0.02, 0.25, 0.045]\n");
  EXPECT_NE(zone.find("ground_colour"), std::string::npos) << zone;
  EXPECT_NE(zone.find("the green zone"), std::string::npos) << zone;
  EXPECT_NE(zone.find("accepted"), std::string::npos) << zone;
  const std::string line = error_of(kMinimal + mission + "ground_colour: [0.03, 0.13, 0.62]\n");
  EXPECT_NE(line.find("the line"), std::string::npos) << line;
  const std::string drawn = "name: x\nmission: {sequence: [red], line_colour: blue}\nrandom: {}\n";
  EXPECT_NE(error_of(drawn + "ground_colour: [0.62, 0.03, 0.03]\n").find("the red zone"), std::string::npos);
}

TEST(ScenarioFile, EveryShippedFileIsAcceptedForManySeeds) {
  for (const auto& entry : std::filesystem::directory_iterator(testing::source_path("sim/scenarios"))) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_TRUE(Configuration::load(entry.path()).has("mission")) << entry.path();
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
      EXPECT_NO_THROW((void)load_scenario(entry.path(), seed)) << entry.path() << " seed " << seed;
    }
  }
}

TEST(ScenarioFile, TheCaseStudyHasTheObjectsAndZonesOfThePaper) {
  const Scenario scenario = load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), 3);
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

TEST(ScenarioFile, LinesOfTheCaseStudyHaveTheirLengthAndRadius) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scenario scenario = load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), seed);
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

TEST(ScenarioFile, WithoutALineOnlyTheWorldIsAFrame) {
  const std::string line = "line: {colour: blue, width_m: 0.05, begin_m: [1, 0], segments: [{length_m: 2}]}\n";
  const std::string object = "colour: red, radius_m: 0.08, height_m: 0.15, mass_kg: 0.4";
  for (const std::string frame : {"line_begin", "line_end"}) {
    const std::string at = "frame: " + frame + ", position_m: [0.6, 0.5]";
    for (const auto& [key, bodies] : {std::pair<std::string, std::string>{"objects[0]", "objects: [{" + object},
                                      {"zones[0]", "zones: [{colour: red, radius_m: 0.3"},
                                      {"obstacles[0]", "obstacles: [{radius_m: 0.03, height_m: 0.1"}}) {
      const std::string text = kMinimal + bodies + ", " + at + "}]\n";
      EXPECT_EQ(error_of(text),
                "x.yaml:3: " + key + ".frame: found " + frame + ", accepted world, because the scenario has no line");
      EXPECT_NO_THROW((void)read(text + line));
    }
    const std::string start = error_of("name: x\nstart: {" + at + "}\n");
    EXPECT_NE(start.find("start.frame: found " + frame + ", accepted world"), std::string::npos) << start;
  }
  EXPECT_NO_THROW((void)read(kMinimal + "objects: [{" + object + ", frame: world, position_m: [0.6, 0.5]}]\n"));
}

TEST(ScenarioFile, AnObjectMustNotLieUnderALongRobot) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "x.yaml";
  std::ofstream(file) << kMinimal
                      << "objects: [{colour: red, position_m: [-2.9, 0], radius_m: 0.08, height_m: 0.15, "
                         "mass_kg: 0.4}]\n";
  const auto load = [&](double length_m, double half_width_m) {
    return load_scenario(file, 1, length_m, half_width_m).objects.at(0).position_m;
  };
  EXPECT_EQ(load(2.16, 0.05), load_scenario(file, 1).objects.at(0).position_m);
  EXPECT_NO_THROW((void)load(2.7, 0.05));
  try {
    (void)load(3.6, 0.05);
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    const std::string text = error.what();
    for (const char* part : {"x.yaml", "start", "objects[0] overlaps the robot's body", "3.60 m"})
      EXPECT_NE(text.find(part), std::string::npos) << text;
  }
}

TEST(ScenarioFile, ReadsObstaclesAndPerturbations) {
  const Scenario scenario =
      read(kMinimal +
           "objects:\n- {colour: red, shape: box, size_m: [0.1, 0.2, 0.3], mass_kg: 1, position_m: [1, 0]}\n"
           "obstacles:\n- {shape: box, size_m: [4, 0.1, 0.3], position_m: [0, 2], yaw_rad: 0.3}\n"
           "- {radius_m: 0.03, height_m: 0.2, position_m: [0, -1]}\n"
           "perturbations:\n- {object: 0, when_displaced_m: 0.5, duration_s: 2, force_n: [0, 20, 0]}\n"
           "- {object: 0, at_s: 3, moved_m: [0.5, -1]}\n"
           "noise: {sensors: false}\n");
  ASSERT_EQ(scenario.obstacles.size(), 2U);
  EXPECT_EQ(scenario.obstacles[1].shape, BodyShape::kCylinder);
  EXPECT_EQ(scenario.objects[0].shape, BodyShape::kBox);
  ASSERT_EQ(scenario.perturbations.size(), 2U);
  EXPECT_EQ(scenario.perturbations[1].moved_m, Eigen::Vector2d(0.5, -1.0));
  EXPECT_TRUE(std::isnan(scenario.perturbations[0].at_s));
  EXPECT_EQ(scenario.perturbations[0].displaced_m, 0.5);
  EXPECT_FALSE(scenario.sensor_noise);
}

TEST(ScenarioFile, NamesTheErrorAndTheAcceptedValues) {
  const std::string object =
      "objects:\n- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [1, 0]}\n";
  EXPECT_EQ(error_of(kMinimal + "objects:\n- {colour: pink, radius_m: 0.1}\n"),
            "x.yaml:4: objects[0].colour: found pink, accepted one of green, red, blue, yellow");
  EXPECT_EQ(
      error_of(kMinimal + object + "- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [1.1, 0]}\n"),
      "x.yaml:3: objects: found that objects[1] overlaps objects[0], accepted bodies that do not overlap");
  EXPECT_EQ(error_of(kMinimal + object + "perturbations:\n- {object: 1}\n"),
            "x.yaml:6: perturbations[0].object: found 1, accepted a whole number 0 to 0");
  EXPECT_EQ(
      error_of(kMinimal + object + "perturbations:\n- {object: 0, duration_s: 1}\n"),
      "x.yaml:6: perturbations[0].at_s: found both or neither of at_s and when_displaced_m, accepted one of them");
  EXPECT_EQ(error_of(kMinimal + "line: {colour: blue, width_m: 0.05, begin_m: [0, 0], segments: []}\n"),
            "x.yaml:3: line.segments: found a list of 0, accepted a list of 1 to 64 maps");
  EXPECT_EQ(error_of("name: x\n"), "x.yaml:1: start: found nothing, accepted a map");
  EXPECT_EQ(error_of(kMinimal + "light: {direction: [0, 1, 0]}\n"),
            "x.yaml:3: light.direction: found a light at or below the horizon, accepted a third number above 0.05");
  EXPECT_EQ(
      error_of(kMinimal + "objects:\n- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [-1, 0]}\n"),
      "x.yaml:3: objects: found that objects[0] overlaps the robot's body at the start, accepted bodies that do not "
      "overlap");
}

TEST(ScenarioFile, RejectsAMissionThatTheSceneDoesNotAllow) {
  const std::string bodies =
      kMinimal + "line: {colour: blue, width_m: 0.05, begin_m: [0, 0], segments: [{length_m: 1}]}\n" +
      "objects:\n- {colour: red, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [1, 0]}\n" +
      "- {colour: green, radius_m: 0.1, height_m: 0.2, mass_kg: 1, position_m: [2, 0]}\n" +
      "zones:\n- {colour: red, radius_m: 0.1, position_m: [-1, 1]}\n";
  EXPECT_EQ(error_of(bodies + "mission: {sequence: [red], line_colour: blue}\n"), "");
  EXPECT_EQ(error_of(bodies + "mission: {sequence: [red, red], line_colour: blue}\n"),
            "x.yaml:9: mission.sequence: found red 2 times, accepted at most the number of red objects, 1");
  EXPECT_EQ(error_of(bodies + "mission: {sequence: [green], line_colour: blue}\n"),
            "x.yaml:9: mission.sequence: found green, accepted colours for which there is a zone");
  EXPECT_EQ(error_of(bodies + "mission: {sequence: [], line_colour: red}\n"),
            "x.yaml:9: mission.line_colour: found red, accepted the colour of the line, blue");
}

}  // namespace
}  // namespace constrictor
