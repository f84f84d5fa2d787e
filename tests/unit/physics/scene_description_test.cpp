#include "sim/physics/scene_description.hpp"

#include <gtest/gtest.h>

#include <string>

#include "sim/scenario_loader/scenario_file.hpp"
#include "support/project.hpp"

namespace constrictor {
namespace {

TEST(SceneDescription, HasTheValuesOfTheScenario) {
  const std::filesystem::path project = testing::source_path();
  const Scenario scenario = load_scenario(project / "sim/scenarios/case_study.yaml", 11);
  const msg::SceneDescription scene =
      scene_description(scenario, load_robot(project / "components/lib/robot/mamba.yaml"));
  EXPECT_EQ(std::string(scene.scenario), "case_study");
  EXPECT_EQ(scene.seed, 11U);
  EXPECT_EQ(scene.module_count, 24);
  ASSERT_EQ(scene.object_count, 2);
  EXPECT_EQ(scene.objects[0].colour, msg::kColourGreen);
  EXPECT_EQ(scene.objects[1].colour, msg::kColourRed);
  EXPECT_EQ(scene.objects[0].size_m.x, scenario.objects[0].size_m.x());
  ASSERT_EQ(scene.zone_count, 2);
  EXPECT_EQ(scene.zones[1].x_m, scenario.zones[1].position_m.x());
  ASSERT_EQ(scene.line_point_count, scenario.line_m.size());
  EXPECT_EQ(scene.line_y_m[60], scenario.line_m[60].y());
  EXPECT_EQ(scene.line_colour, msg::kColourBlue);
}

TEST(SceneDescription, PutsObstaclesOnTheGround) {
  Scenario scenario;
  scenario.obstacles.push_back({BodyShape::kBox, {2.0, 0.1, 0.4}, {1.0, 2.0}, 1.0});
  scenario.ground_gloss = 0.7;
  const msg::SceneDescription scene = scene_description(scenario, RobotModel{});
  ASSERT_EQ(scene.obstacle_count, 1);
  EXPECT_DOUBLE_EQ(scene.obstacles[0].pose.position_m.z, 0.2);
  EXPECT_DOUBLE_EQ(scene.obstacles[0].pose.orientation.z, std::sin(0.5));
  EXPECT_EQ(scene.line_colour, msg::kColourUnknown);
  EXPECT_EQ(scene.ground_gloss, 0.7);
}

}  // namespace
}  // namespace constrictor
