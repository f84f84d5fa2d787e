#include "sim/scenario_loader/layout_check.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "constrictor/messages.hpp"
#include "sim/scenario_loader/line_path.hpp"

namespace constrictor {
namespace {

Scenario scene_with(std::vector<ScenarioObject> objects, std::vector<ScenarioObstacle> obstacles = {}) {
  Scenario scenario;
  scenario.objects = std::move(objects);
  scenario.obstacles = std::move(obstacles);
  return scenario;
}

ScenarioObject cylinder(double x, double y) {
  ScenarioObject object;
  object.size_m = {0.1, 0.1, 0.2};
  object.position_m = {x, y};
  return object;
}

std::string overlap_of(const Scenario& scenario) { return find_overlap(scenario, 2.2, 0.05); }

TEST(LayoutCheck, AcceptsBodiesSideBySide) {
  EXPECT_EQ(overlap_of(scene_with({cylinder(1, 0), cylinder(1.21, 0)})), "");
}

TEST(LayoutCheck, FindsOverlappingCylinders) {
  EXPECT_EQ(overlap_of(scene_with({cylinder(1, 0), cylinder(1.15, 0.1)})), "objects[1] overlaps objects[0]");
}

TEST(LayoutCheck, FindsAnObjectOnTheBodyOfTheRobot) {
  EXPECT_EQ(overlap_of(scene_with({cylinder(-1.5, 0.1)})), "objects[0] overlaps the robot's body at the start");
  EXPECT_EQ(overlap_of(scene_with({cylinder(-1.5, 0.2)})), "");
}

TEST(LayoutCheck, TurnsWallsWithTheirYaw) {
  ScenarioObstacle wall;
  wall.size_m = {2.0, 0.1, 0.3};
  wall.position_m = {2, 0};
  EXPECT_EQ(overlap_of(scene_with({cylinder(2.8, 0.1)}, {wall})), "objects[0] overlaps obstacles[0]");
  wall.yaw_rad = 1.5707963267948966;
  EXPECT_EQ(overlap_of(scene_with({cylinder(2.8, 0.1)}, {wall})), "");
  EXPECT_EQ(overlap_of(scene_with({cylinder(2.1, 0.8)}, {wall})), "objects[0] overlaps obstacles[0]");
}

TEST(LayoutCheck, FindsOverlappingTurnedBoxes) {
  ScenarioObject box;
  box.shape = BodyShape::kBox;
  box.size_m = {0.2, 0.2, 0.2};
  box.position_m = {1, 0};
  ScenarioObject other = box;
  other.position_m = {1.23, 0};
  EXPECT_EQ(overlap_of(scene_with({box, other})), "");
  other.yaw_rad = 0.7853981633974483;  // its corner now reaches 0.141 m
  EXPECT_EQ(overlap_of(scene_with({box, other})), "objects[1] overlaps objects[0]");
}

TEST(LayoutCheck, FindsObstaclesOnTheLine) {
  ScenarioObstacle wall;  // 0.1 m thick and 2 m wide
  wall.size_m = {2.0, 0.1, 0.3};
  ScenarioObstacle peg;
  peg.shape = BodyShape::kCylinder;
  peg.size_m = {0.05, 0.05, 0.3};
  const auto on_line = [&](const Eigen::Vector2d& wall_m, const Eigen::Vector2d& peg_m) {
    wall.position_m = wall_m;
    peg.position_m = peg_m;
    Scenario scenario = scene_with({}, {wall, peg});
    for (int i = 0; i <= 200; ++i) scenario.line_m.emplace_back(0.0, 0.02 * i);
    return find_obstacles_on_line(scenario, 0.035);
  };
  EXPECT_EQ(on_line({0.0, 5.0}, {0.09, 1.0}), std::vector<std::string>{}) << "there is room for the body";
  EXPECT_EQ(on_line({0.9, 2.0}, {0.09, 1.0}),
            std::vector<std::string>{"obstacles[0] stands on the line, 1.92 m from its beginning: the robot cannot "
                                     "follow the line there"});
  EXPECT_EQ(on_line({0.0, 5.0}, {0.08, 1.0}).size(), 1U) << "the line passes 0.03 m beside the peg";
  EXPECT_EQ(on_line({0.0, 4.0}, {0.0, 0.0}).size(), 2U);
}

// The radii and angles were measured (README.md of scenario_loader, "Lines that turn back").
TEST(LayoutCheck, ALineThatTurnsBackIsFound) {
  const auto bend = [](double radius_m, double degrees) {
    const double angle_rad = degrees * std::numbers::pi / 180.0;
    Scenario scenario;
    scenario.line_m =
        make_line_path({}, {{2.0, 0.0}, {radius_m * angle_rad, 1.0 / radius_m}, {2.0, 0.0}}, msg::kMaxLinePoints)
            .points_m;
    const std::vector<std::string> texts = find_turns_back(scenario);
    if (texts.empty()) return "accepted";
    return texts[0].find("beside itself") != std::string::npos ? "beside itself" : "sharp";
  };
  EXPECT_STREQ(bend(0.8, 180.0), "accepted");
  EXPECT_STREQ(bend(0.6, 180.0), "beside itself");
  EXPECT_STREQ(bend(0.2, 180.0), "sharp");
  EXPECT_STREQ(bend(0.3, 135.0), "sharp");
  EXPECT_STREQ(bend(0.6, 135.0), "accepted");
  EXPECT_STREQ(bend(0.2, 90.0), "accepted");
  EXPECT_EQ(find_turns_back(Scenario{}), std::vector<std::string>{}) << "there is no line";
}

}  // namespace
}  // namespace constrictor
