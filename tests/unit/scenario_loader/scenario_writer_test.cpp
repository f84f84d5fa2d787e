// What is written as a scenario file and read again is the same scene.
#include "sim/scenario_loader/scenario_writer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "component/mission.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

constexpr double kLastBits = 1e-15;  // of what is computed anew when a file is read

Scenario read_text(const std::string& text, std::uint64_t seed) {
  return read_scenario(Configuration::parse(text, "x.yaml"), seed);
}

/// Angles are equal up to whole turns.
void expect_same_angle(double a, double b) { EXPECT_NEAR(std::remainder(a - b, 2.0 * M_PI), 0.0, 1e-12); }

void expect_same_bodies(const Scenario& drawn, const Scenario& again) {
  ASSERT_EQ(drawn.objects.size(), again.objects.size());
  for (std::size_t i = 0; i < drawn.objects.size(); ++i) {
    const ScenarioObject &a = drawn.objects[i], &b = again.objects[i];
    EXPECT_EQ(a.colour, b.colour);
    EXPECT_EQ(a.shape, b.shape);
    EXPECT_EQ(a.size_m, b.size_m);
    EXPECT_EQ(a.mass_kg, b.mass_kg);
    EXPECT_EQ(a.position_m, b.position_m);
    expect_same_angle(a.yaw_rad, b.yaw_rad);
  }
  ASSERT_EQ(drawn.zones.size(), again.zones.size());
  for (std::size_t i = 0; i < drawn.zones.size(); ++i) {
    EXPECT_EQ(drawn.zones[i].colour, again.zones[i].colour);
    EXPECT_EQ(drawn.zones[i].position_m, again.zones[i].position_m);
    EXPECT_EQ(drawn.zones[i].radius_m, again.zones[i].radius_m);
  }
  ASSERT_EQ(drawn.obstacles.size(), again.obstacles.size());
  for (std::size_t i = 0; i < drawn.obstacles.size(); ++i) {
    EXPECT_EQ(drawn.obstacles[i].shape, again.obstacles[i].shape);
    EXPECT_EQ(drawn.obstacles[i].size_m, again.obstacles[i].size_m);
    EXPECT_EQ(drawn.obstacles[i].position_m, again.obstacles[i].position_m);
    expect_same_angle(drawn.obstacles[i].yaw_rad, again.obstacles[i].yaw_rad);
  }
}

void expect_same_perturbations(const Scenario& drawn, const Scenario& again) {
  const auto same_or_unused = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  ASSERT_EQ(drawn.perturbations.size(), again.perturbations.size());
  for (std::size_t i = 0; i < drawn.perturbations.size(); ++i) {
    const ScenarioPerturbation &a = drawn.perturbations[i], &b = again.perturbations[i];
    EXPECT_EQ(a.object, b.object);
    EXPECT_TRUE(same_or_unused(a.at_s, b.at_s));
    EXPECT_TRUE(same_or_unused(a.displaced_m, b.displaced_m));
    EXPECT_EQ(a.duration_s, b.duration_s);
    EXPECT_EQ(a.force_n, b.force_n);
    EXPECT_EQ(a.moved_m, b.moved_m);
  }
}

void expect_same_scene(const Scenario& drawn, const Scenario& again) {
  EXPECT_EQ(drawn.name, again.name);
  EXPECT_EQ(drawn.line_m, again.line_m);
  EXPECT_EQ(drawn.line_width_m, again.line_width_m);
  EXPECT_EQ(drawn.line_colour, again.line_colour);
  expect_same_bodies(drawn, again);
  expect_same_perturbations(drawn, again);
  EXPECT_EQ(drawn.friction.ground_scale, again.friction.ground_scale);
  EXPECT_EQ(drawn.friction.object_robot, again.friction.object_robot);
  EXPECT_EQ(drawn.friction.object_ground, again.friction.object_ground);
  EXPECT_EQ(drawn.friction.robot_robot, again.friction.robot_robot);
  EXPECT_EQ(drawn.body.mass_scale, again.body.mass_scale);
  EXPECT_LT((drawn.light.direction - again.light.direction).norm(), kLastBits);
  EXPECT_EQ(drawn.light.intensity, again.light.intensity);
  EXPECT_EQ(drawn.light.ambient, again.light.ambient);
  EXPECT_EQ(drawn.ground_colour, again.ground_colour);
  EXPECT_EQ(drawn.ground_gloss, again.ground_gloss);
  EXPECT_EQ(drawn.start_m, again.start_m);
  expect_same_angle(drawn.start_yaw_rad, again.start_yaw_rad);
  EXPECT_LT((drawn.gravity_m_s2 - again.gravity_m_s2).norm(), 10.0 * kLastBits);
  EXPECT_EQ(drawn.sensor_noise, again.sensor_noise);
  EXPECT_EQ(drawn.camera_noise_sd, again.camera_noise_sd);
}

std::vector<std::string> shipped() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(testing::source_path("sim/scenarios")))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  return names;
}

class WrittenScenario : public ::testing::TestWithParam<std::string> {};

TEST_P(WrittenScenario, HasTheSameSceneWithAnySeed) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(seed);
    const Scenario drawn = load_scenario(testing::source_path("sim/scenarios/" + GetParam() + ".yaml"), seed);
    const std::string text = scenario_text(drawn, "", "one\ntwo");
    EXPECT_TRUE(text.starts_with("# one\n# two\nname: " + GetParam() + "\n")) << text;
    expect_same_scene(drawn, read_text(text, seed));
    expect_same_scene(drawn, read_text(text, seed + 1000));
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, WrittenScenario, ::testing::ValuesIn(shipped()),
                         [](const auto& made) { return made.param; });

// What no shipped scenario has: walls and boxes that are turned by more than one turn, forces, and a heavier body.
TEST(ScenarioWriter, WritesEveryKeyOfAScene) {
  const Scenario drawn = read_text(
      "name: 'a name: with # signs'\n"
      "line: {colour: red, width_m: 0.04, begin_m: [1, 2], begin_yaw_rad: 6.2, segments: [{length_m: 9, "
      "curvature_1_m: 1}]}\n"
      "objects:\n"
      "  - {colour: blue, shape: box, size_m: [0.1, 0.2, 0.3], mass_kg: 1, frame: line_end, position_m: [2, 1], "
      "yaw_rad: 6}\n"
      "  - {colour: green, radius_m: 0.1, height_m: 0.2, mass_kg: 0.5, position_m: [-4, -4]}\n"
      "obstacles: [{shape: box, size_m: [2, 0.1, 0.3], frame: line_end, position_m: [5, 0], yaw_rad: -6}]\n"
      "perturbations:\n"
      "  - {object: 0, at_s: 3.3, duration_s: 0.7, force_n: [1, 2, -3]}\n"
      "  - {object: 1, when_displaced_m: 0.1, duration_s: 1, force_n: [0, 0, 5]}\n"
      "  - {object: 1, at_s: 9, moved_m: [0.3, -0.1]}\n"
      "friction: {ground_scale: 1.7, object_robot: 0.6, object_ground: 0.3, robot_robot: 0.1}\n"
      "body: {mass_scale: 1.25}\n"
      "light: {direction: [0.1, 0.2, 0.7], intensity: 0.9, ambient: 0.2}\n"
      "slope: {grade: 0.07, uphill_rad: -2.5}\n"
      "ground_colour: [0.1, 0.2, 0.3]\n"
      "ground_gloss: 0.7\n"
      "noise: {sensors: false, camera_sd: 0.02}\n"
      "start: {frame: line_begin, position_m: [-3, 0], yaw_rad: 6}\n",
      1);
  ASSERT_GT(drawn.objects[0].yaw_rad, 2.0 * M_PI) << "the case with more than one turn";
  expect_same_scene(drawn, read_text(scenario_text(drawn, "", "c"), 1));
}

TEST(ScenarioWriter, TheMissionKeepsAllItsKeys) {
  const std::filesystem::path file = testing::source_path("sim/scenarios/random_middle.yaml");
  const std::string mission =
      "{sequence: [green, red], line_colour: blue, known: {zone_radius_m: 0.35}, time_limits: {mission_s: 600}}";
  Configuration root = Configuration::parse(scenario_text(load_scenario(file, 3), mission, "c"), "x.yaml");
  const Mission read = read_mission(root.section("mission"));
  EXPECT_EQ(read.sequence, (std::vector<std::uint8_t>{msg::kColourGreen, msg::kColourRed}));
  EXPECT_EQ(read.line_colour, msg::kColourBlue);
  EXPECT_EQ(read.known.zone_radius_m, 0.35);
  EXPECT_EQ(read.limits.mission_s, 600.0);
}

// The variation of a radius of 0.5 m reaches beyond the largest radius that a file may have.
TEST(ScenarioWriter, RefusesASceneThatAFileCannotHave) {
  const std::string file =
      "name: x\nstart: {position_m: [0, 0]}\nvariation: {radius: 0.9}\n"
      "objects: [{colour: green, radius_m: 0.5, height_m: 0.2, mass_kg: 1, position_m: [9, 9]}]\n";
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Scenario drawn = read_text(file, seed);
    try {
      static_cast<void>(scenario_text(drawn, "", "c"));
      EXPECT_LE(drawn.objects[0].size_m.x(), 0.5);
    } catch (const ConfigurationError& error) {
      ++refused;
      EXPECT_GT(drawn.objects[0].size_m.x(), 0.5);
      EXPECT_NE(std::string(error.what()).find("the drawn scene:"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("objects[0].radius_m: found"), std::string::npos) << error.what();
    }
  }
  EXPECT_GT(refused, 3);
  EXPECT_LT(refused, 17);
}

}  // namespace
}  // namespace constrictor
