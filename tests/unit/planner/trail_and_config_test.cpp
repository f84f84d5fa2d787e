// The planner's memory of the line, and the errors of its configuration file.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <string>

#include "configuration/configuration.hpp"
#include "planner/line_trail.hpp"
#include "planner/planner_config.hpp"
#include "planner/short_text.hpp"
#include "robot/planar.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

TEST(LineTrail, KnowsDirectionAndBearingOfACurvedLineBothWays) {
  // A quarter circle of radius 2 m to the left, from the origin along x. Each percept has the point 0.35 m ahead.
  LineTrail trail;
  msg::LinePercept line{};
  line.visible = true;
  line.lookahead_m = 0.35;
  for (double s = 0.0; s < std::numbers::pi; s += 0.02) {
    const double angle = s / 2.0;
    msg::RobotPose pose{};
    pose.x_m = 2.0 * std::sin(angle);
    pose.y_m = 2.0 - 2.0 * std::cos(angle);
    pose.yaw_rad = angle;
    const double ahead = std::asin(0.35 / 2.0);
    line.offset_m = 2.0 * (1.0 - std::cos(ahead));
    line.heading_rad = ahead;
    trail.record(line, pose, true);
  }
  for (double angle = 0.3; angle < 1.5; angle += 0.05) {
    msg::RobotPose pose{};
    pose.x_m = 2.0 * std::sin(angle);
    pose.y_m = 2.0 - 2.0 * std::cos(angle);
    EXPECT_NEAR(*trail.direction_rad(pose, true), angle, 0.1);
    EXPECT_NEAR(std::abs(wrap_angle(*trail.direction_rad(pose, false) - angle)), std::numbers::pi, 0.1);
    EXPECT_EQ(trail.heading_rad(pose, true), trail.direction_rad(pose, true));
    // One metre beside the line, the heading leads to a point 0.6 m further along the tangent.
    for (const double beside_m : {1.0, -1.0}) {
      msg::RobotPose beside = pose;
      beside.x_m -= beside_m * std::sin(angle);
      beside.y_m += beside_m * std::cos(angle);
      const double across = std::remainder(*trail.heading_rad(beside, true) - angle, 2.0 * std::numbers::pi);
      EXPECT_NEAR(across, beside_m > 0.0 ? -1.03 : 1.03, 0.35) << angle;  // atan(1 m / 0.6 m) to the tangent
    }
  }
}

TEST(LineTrail, LeadsRoundAnObstacleToTheNearestPointOfTheLineThatIsReachable) {
  LineTrail trail;  // the x axis
  msg::LinePercept line{};
  line.visible = true;
  line.lookahead_m = 0.35;
  msg::RobotPose pose{};
  for (pose.x_m = 0.0; pose.x_m < 4.0; pose.x_m += 0.05) trail.record(line, pose, true);
  pose.x_m = 2.0;
  pose.y_m = -0.4;
  // A wall that ends at x = 2.5 m stands between the robot and the line.
  const LineTrail::Reachable beyond_the_wall = [](double x_m, double) { return x_m > 2.5; };
  EXPECT_EQ(trail.heading_rad(pose, true), trail.direction_rad(pose, true)) << "beside the line without a wall";
  for (const bool outbound : {true, false}) {
    const double heading_rad = *trail.heading_rad(pose, outbound, beyond_the_wall);
    const double x_m = pose.x_m - pose.y_m / std::tan(heading_rad);  // where this heading meets the line
    EXPECT_GT(heading_rad, 0.0);
    EXPECT_GT(x_m, 2.5);
    EXPECT_LT(x_m, 2.85) << "the nearest of the points, which are 0.3 m apart";
  }
  const LineTrail::Reachable nowhere = [](double, double) { return false; };
  pose.y_m = -1.0;
  EXPECT_EQ(trail.heading_rad(pose, true, nowhere), trail.heading_rad(pose, true)) << "it has to try";
}

TEST(LineTrail, LeadsToTheLastVisiblePointOfABendAndOverNewGroundOnly) {
  // Along x for 2 m, then a corner of 110 degrees to the left.
  LineTrail trail;
  msg::LinePercept line{};
  line.visible = true;
  line.lookahead_m = 0.35;
  line.point_count = 1;
  msg::RobotPose pose{};
  const auto see = [&](double x_m, double y_m) {  // a point of M, from the pose
    line.x_m[0] = std::cos(pose.yaw_rad) * (x_m - pose.x_m) + std::sin(pose.yaw_rad) * (y_m - pose.y_m);
    line.y_m[0] = -std::sin(pose.yaw_rad) * (x_m - pose.x_m) + std::cos(pose.yaw_rad) * (y_m - pose.y_m);
  };
  for (pose.x_m = 0.0; pose.x_m < 1.65; pose.x_m += 0.05) {
    see(std::min(2.0, pose.x_m + 0.8), pose.x_m > 1.5 ? 0.3 : 0.0);
    trail.note_beyond(line, pose);
    trail.record(line, pose, true);
  }
  pose.x_m = 2.3;  // the robot has lost the line and passed the corner
  pose.yaw_rad = 0.3;
  EXPECT_NEAR(*trail.heading_rad(pose, true), std::atan2(0.3, -0.3), 1e-9);
  EXPECT_NEAR(std::abs(wrap_angle(*trail.heading_rad(pose, false))), std::numbers::pi,
              0.3);  // the way back does not use that point
  const double corner_rad = 110.0 / 180.0 * std::numbers::pi;
  see(2.0 + 0.9 * std::cos(corner_rad), 0.9 * std::sin(corner_rad));
  EXPECT_TRUE(trail.leads_to_new_ground(line, pose));
  pose.covariance[0] = pose.covariance[4] = 0.3 * 0.3;  // it may be a known point
  EXPECT_FALSE(trail.leads_to_new_ground(line, pose));
  pose.covariance[0] = pose.covariance[4] = 0.0;
  see(1.0, 0.0);  // behind the robot
  EXPECT_FALSE(trail.leads_to_new_ground(line, pose));
  see(0.3, 0.8);  // new ground, but not where the line was followed last
  EXPECT_FALSE(trail.leads_to_new_ground(line, pose));
  line.x_m[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(trail.leads_to_new_ground(line, pose));
}

TEST(LineTrail, ReverseTurnsDirectionsRoundAndAnUnknownLineHasNone) {
  LineTrail trail;
  msg::RobotPose pose{};
  EXPECT_FALSE(trail.direction_rad(pose, true));
  EXPECT_FALSE(trail.heading_rad(pose, true));
  msg::LinePercept line{};
  line.visible = true;
  line.lookahead_m = 0.35;
  line.heading_rad = std::numeric_limits<double>::quiet_NaN();
  trail.record(line, pose, true);
  EXPECT_TRUE(trail.empty());
  line.heading_rad = 0.4;
  trail.record(line, pose, true);
  trail.reverse();
  EXPECT_NEAR(*trail.direction_rad(pose, true), 0.4 - std::numbers::pi, 1e-12);
}

TEST(PlannerConfig, TheShippedFileHoldsTheDefaults) {
  const auto config = load_parameters<PlannerConfig>(testing::source_path("components/planner/planner.yaml"));
  EXPECT_EQ(config.sequence, (std::vector<std::uint8_t>{msg::kColourGreen, msg::kColourRed}));
}

TEST(PlannerConfig, TheMissionOfTheScenarioTakesPrecedence) {
  const auto config = load_planner_config({}, "{sequence: [yellow], line_colour: red}");
  EXPECT_EQ(config.sequence, (std::vector<std::uint8_t>{msg::kColourYellow}));
  EXPECT_EQ(config.line_colour, msg::kColourRed);
  EXPECT_EQ(load_planner_config({}, "").sequence.size(), 2U);
  const PlannerConfig limited = load_planner_config(
      {},
      "{sequence: [red], line_colour: blue, known: {zones_at: anywhere}, time_limits: {mission_s: 600, drop_s: 40}}");
  EXPECT_EQ(limited.zones_at, kZonesAnywhere);
  EXPECT_EQ(limited.mission_timeout_s, 600.0);
  EXPECT_EQ(limited.drop_timeout_s, 40.0);
  EXPECT_EQ(limited.task_timeout_s, PlannerConfig{}.task_timeout_s);
  EXPECT_EQ(load_planner_config({}, "{sequence: [red], line_colour: blue, known: {zone_radius_m: 0.25}}").zone_radius_m,
            0.25);
  EXPECT_TRUE(load_planner_config({}, "{sequence: [], line_colour: blue}").sequence.empty());
  for (const auto& [mission, message] : {std::pair{"{sequence: [pink], line_colour: blue}", "--mission:1: sequence"},
                                         {"{sequence: [blue], line_colour: blue}", "found the colour of an object"},
                                         {"{sequence: [green], line_color: blue}", "line_colo"}}) {
    try {
      static_cast<void>(load_planner_config({}, mission));
      FAIL() << mission;
    } catch (const ConfigurationError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

TEST(PlannerConfig, AnErrorNamesFileLineKeyAndTheAcceptedValues) {
  const testing::TemporaryFolder folder;
  const auto message_of = [&](const std::string& text) -> std::string {
    const auto file = folder.path() / "bad_planner.yaml";
    std::ofstream(file) << text << "\n";
    try {
      static_cast<void>(load_parameters<PlannerConfig>(file));
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message_of("# mission\nsequence: [green, pink]").find("bad_planner.yaml:2: sequence"), std::string::npos);
  EXPECT_NE(message_of("sequence: [green, pink]").find("pink"), std::string::npos);
  EXPECT_NE(message_of("sequence: [green, blue]").find("accepted other colours"), std::string::npos);
  EXPECT_EQ(message_of("sequence: []"), "") << "a mission without objects";
  EXPECT_NE(message_of("confirm_images: 0").find("confirm_images: found 0"), std::string::npos);
  EXPECT_NE(message_of("explore: 8").find("explore"), std::string::npos);
  EXPECT_EQ(message_of("sequence: [red]"), "") << "the other keys keep their defaults";
}

TEST(ShortText, EndsAfterAWord) {
  EXPECT_EQ(shortened("not delivered", 13), "not delivered");
  EXPECT_EQ(shortened("not delivered: green", 17), "not ...") << "the colon belongs to the word before";
  EXPECT_EQ(shortened("not delivered: green", 18), "not delivered: ...");
  EXPECT_EQ(shortened("onewordonly", 8), "onew ...");
  for (std::size_t bytes = 5; bytes < 40; ++bytes)
    EXPECT_LE(shortened("the object is too large for the U: found a radius of 0.139 m", bytes).size(), bytes);
}

}  // namespace
}  // namespace constrictor
