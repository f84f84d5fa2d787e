// Which tilts of the head's camera are warned of. Missions with six tilts were tried (components/perception/README.md).
#include "perception/view_limits.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "component/data_path.hpp"

namespace constrictor::perception {
namespace {

TEST(ViewLimits, EachShippedRobotSeesTheHorizon) {
  for (const auto& entry : std::filesystem::directory_iterator(data_path("components/lib/robot"))) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_TRUE(judge_view(load_robot(entry.path())).warnings.empty()) << entry.path();
  }
}

TEST(ViewLimits, ACameraThatLooksBelowTheHorizonIsWarnedOf) {
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  robot.camera.tilt_rad = 0.6;
  EXPECT_TRUE(judge_view(robot).warnings.empty());
  robot.camera.tilt_rad = 0.65;
  ASSERT_EQ(judge_view(robot).warnings.size(), 1u);
  EXPECT_NE(judge_view(robot).warnings[0].find("accepted less than 0.644"), std::string::npos)
      << judge_view(robot).warnings[0];
  robot.camera.horizontal_fov_rad = 2.0;
  EXPECT_TRUE(judge_view(robot).warnings.empty()) << "a wider image contains the horizon";
}

}  // namespace
}  // namespace constrictor::perception
