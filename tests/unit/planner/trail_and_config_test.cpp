// The memory of the line, and the planner's file.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numbers>
#include <sstream>

#include "configuration/configuration.hpp"
#include "planner/line_trail.hpp"
#include "planner/planner_config.hpp"

namespace constrictor {
namespace {

TEST(LineTrail, KnowsDirectionAndBearingOfACurvedLineBothWays) {
  // A quarter circle of radius 2 m to the left, from the origin along x, seen 0.35 m ahead.
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
    EXPECT_NEAR(std::abs(wrapped(*trail.direction_rad(pose, false) - angle)), std::numbers::pi, 0.1);
    EXPECT_EQ(trail.heading_rad(pose, true), trail.direction_rad(pose, true));
    // From a metre beside the line it leads to a place 0.6 m further along the tangent.
    for (const double beside_m : {1.0, -1.0}) {
      msg::RobotPose beside = pose;
      beside.x_m -= beside_m * std::sin(angle);
      beside.y_m += beside_m * std::cos(angle);
      const double across = std::remainder(*trail.heading_rad(beside, true) - angle, 2.0 * std::numbers::pi);
      EXPECT_NEAR(across, beside_m > 0.0 ? -1.03 : 1.03, 0.35) << angle;  // atan(1 m / 0.6 m) to the tangent
    }
  }
}

TEST(LineTrail, LeadsToWhereABendWasSeenLastAndOnOverNewGroundOnly) {
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
  pose.x_m = 2.3;  // lost, and run past the corner
  pose.yaw_rad = 0.3;
  EXPECT_NEAR(*trail.heading_rad(pose, true), std::atan2(0.3, -0.3), 1e-9);
  EXPECT_NEAR(std::abs(wrapped(*trail.heading_rad(pose, false))), std::numbers::pi, 0.3);  // the way back is not concerned
  const double corner_rad = 110.0 / 180.0 * std::numbers::pi;
  see(2.0 + 0.9 * std::cos(corner_rad), 0.9 * std::sin(corner_rad));
  EXPECT_TRUE(trail.leads_on(line, pose));
  see(1.0, 0.0);  // where it came from
  EXPECT_FALSE(trail.leads_on(line, pose));
  see(0.3, 0.8);  // new ground, but not where the line was followed last
  EXPECT_FALSE(trail.leads_on(line, pose));
  line.x_m[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(trail.leads_on(line, pose));
}

TEST(LineTrail, ReversedLeadsTheOtherWayAndUnknownIsSaid) {
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

TEST(PlannerConfig, DefaultFileIsAccepted) {
  const auto config = load_planner_config(std::string(CONSTRICTOR_SOURCE_DIR) + "/components/planner/planner.yaml");
  EXPECT_EQ(config.sequence, (std::vector<std::uint8_t>{msg::kColourGreen, msg::kColourRed}));
}

TEST(PlannerConfig, NamesFileLineKeyAndWhatIsAccepted) {
  std::ifstream source(std::string(CONSTRICTOR_SOURCE_DIR) + "/components/planner/planner.yaml");
  std::stringstream text;
  text << source.rdbuf();
  const auto message_of = [&](const std::string& from, const std::string& to) -> std::string {
    std::string changed = text.str();
    changed.replace(changed.find(from), from.size(), to);
    const auto file = std::filesystem::path(::testing::TempDir()) / "bad_planner.yaml";
    std::ofstream(file) << changed;
    try {
      (void)load_planner_config(file);
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(message_of("[green, red]", "[green, pink]").find("bad_planner.yaml:2: sequence"), std::string::npos);
  EXPECT_NE(message_of("[green, red]", "[green, pink]").find("pink"), std::string::npos);
  EXPECT_NE(message_of("[green, red]", "[green, blue]").find("accepted others"), std::string::npos);
  EXPECT_NE(message_of("[green, red]", "[]").find("accepted 1 to 16"), std::string::npos);
  EXPECT_NE(message_of("confirm_images: 3", "confirm_images: 0").find("confirm_images: found 0"), std::string::npos);
  EXPECT_NE(message_of("explore_s", "explore").find("explore"), std::string::npos);
}

}  // namespace
}  // namespace constrictor
