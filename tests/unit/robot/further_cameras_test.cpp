// The further cameras of a robot file: what is accepted, and where they are.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "configuration/configuration.hpp"
#include "robot/camera_mount.hpp"
#include "robot/description.hpp"
#include "robot/robot_model.hpp"
#include "support/project.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor {
namespace {

const std::filesystem::path kRobotFiles = testing::source_path("components/lib/robot");

/// mamba.yaml with this list of further cameras.
RobotModel with_further_cameras(const std::string& list) {
  std::ifstream original(kRobotFiles / "mamba.yaml");
  std::ostringstream text;
  text << original.rdbuf() << "further_cameras: " << list << "\n";
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "robot.yaml";
  std::ofstream(file) << text.str();
  return load_robot(file);
}

std::string error_of(const std::string& list) {
  try {
    (void)with_further_cameras(list);
  } catch (const ConfigurationError& error) {
    const std::string what = error.what();
    return what.substr(what.find(": ") + 2);
  }
  return {};
}

TEST(FurtherCameras, TakeWhatIsLeftOutFromTheHeadsCamera) {
  const RobotModel robot = with_further_cameras(
      "[{name: rear, position_m: [-0.02, 0, 0.08], yaw_rad: 3, tilt_rad: 0.2},"
      " {name: left, module: 5, position_m: [0, 0.04, 0], tilt_rad: 0.1, width: 64, height: 48, "
      "horizontal_fov_rad: 1}]");
  ASSERT_EQ(robot.further_cameras.size(), 2U);
  const CameraModel& rear = robot.further_cameras[0];
  EXPECT_EQ(rear.name, "rear");
  EXPECT_EQ(rear.module, 0U);
  EXPECT_EQ(rear.width, robot.camera.width);
  EXPECT_EQ(rear.horizontal_fov_rad, robot.camera.horizontal_fov_rad);
  EXPECT_EQ(rear.yaw_rad, 3.0);
  EXPECT_EQ(rear.period_ticks, robot.camera.period_ticks);
  const CameraModel& left = robot.further_cameras[1];
  EXPECT_EQ(left.module, 5U);
  EXPECT_EQ(left.width, 64);
  EXPECT_EQ(left.yaw_rad, 0.0);
  EXPECT_EQ(left.latency_ticks, robot.camera.latency_ticks);
  EXPECT_EQ(robot.camera_of(0), &robot.camera);
  EXPECT_EQ(robot.camera_of(2), &left);
  EXPECT_EQ(robot.camera_of(3), nullptr);
  EXPECT_TRUE(load_robot(kRobotFiles / "mamba.yaml").further_cameras.empty());
  EXPECT_EQ(load_robot(kRobotFiles / "mamba_two_cameras.yaml").further_cameras.size(), 1U);
}

// A point ahead of a camera that looks to the left and down lies to the left of the module and below the camera.
TEST(FurtherCameras, LookInTheDirectionOfTheirYawAndTilt) {
  for (const double yaw : {-2.5, -0.4, 0.0, 1.0, std::numbers::pi}) {
    CameraModel camera;
    camera.p_HC = {0.01, 0.02, 0.06};
    camera.yaw_rad = yaw;
    camera.tilt_rad = 0.3;
    const Eigen::Isometry3d X_MC = camera_mount(camera);
    const Eigen::Vector3d ahead = X_MC * Eigen::Vector3d(0, 0, 2.0) - camera.p_HC;
    EXPECT_NEAR(ahead.x(), 2.0 * std::cos(0.3) * std::cos(yaw), 1e-12);
    EXPECT_NEAR(ahead.y(), 2.0 * std::cos(0.3) * std::sin(yaw), 1e-12);
    EXPECT_NEAR(ahead.z(), -2.0 * std::sin(0.3), 1e-12);
    // The image is upright: its right side is to the right of the view, and level.
    const Eigen::Vector3d right = X_MC.linear().col(0);
    EXPECT_NEAR(right.x(), std::sin(yaw), 1e-12);
    EXPECT_NEAR(right.y(), -std::cos(yaw), 1e-12);
    EXPECT_NEAR(right.z(), 0.0, 1e-12);
    EXPECT_NEAR(X_MC.linear().determinant(), 1.0, 1e-12);
  }
}

TEST(FurtherCameras, ErrorsNameKeyFoundAndAccepted) {
  const std::string rest = "position_m: [0, 0, 0.06], tilt_rad: 0.3";
  const auto one = [&](const std::string& keys) { return error_of("[{" + keys + "}]"); };
  EXPECT_EQ(one("name: rear, " + rest), "");
  EXPECT_EQ(one(rest).substr(0, 40), "further_cameras[0].name: found nothing, ");
  EXPECT_EQ(one("name: Rear eye, " + rest),
            "further_cameras[0].name: found 'Rear eye', accepted 1 to 31 characters of a to z, 0 to 9 and _");
  EXPECT_EQ(error_of("[{name: a, " + rest + "}, {name: a, " + rest + "}]"),
            "further_cameras[1].name: found 'a' twice, accepted names that differ");
  EXPECT_EQ(one("name: a, module: 24, " + rest),
            "further_cameras[0].module: found 24, accepted a whole number 0 to 23");
  EXPECT_EQ(one("name: a, width: 31, " + rest),
            "further_cameras[0].width: found 31, accepted a whole number 32 to 4096");
  EXPECT_EQ(one("name: a, yaw_rad: 4, " + rest).substr(0, 48), "further_cameras[0].yaw_rad: found 4, accepted -3");
  EXPECT_EQ(one("name: a, period_ticks: 3, " + rest).substr(0, 51),
            "further_cameras[0].period_ticks: found an unknown k");
  EXPECT_EQ(one("name: a, tilt_rad: 0.3"),
            "further_cameras[0].position_m: found nothing, accepted a list of 3 numbers, each -1 to 1");
  EXPECT_EQ(one("name: a, position_m: [0, 0, 0.02], tilt_rad: 0.3"),
            "further_cameras[0].position_m: found a place 0.02 m from the axis of the module, accepted more than 0.035 "
            "m (module.radius_m): the module hides everything else");
  EXPECT_EQ(one("name: a, position_m: [0, 0.1, -0.03], tilt_rad: 0.3").substr(0, 72),
            "further_cameras[0].position_m: found z = -0.03 m, accepted -0.015 m or m");
  EXPECT_EQ(one("name: a, position_m: [0, 0, 0.06], tilt_rad: -0.7"),
            "further_cameras[0].tilt_rad: found -0.7, accepted -0.594 or more: no ground would be in view");
  std::string four;
  for (const char* name : {"a", "b", "c", "d"}) four += std::string("{name: ") + name + ", " + rest + "}, ";
  EXPECT_EQ(error_of("[" + four + "]"),
            "further_cameras: found a list of 4, accepted at most 3 beside the head's camera");
}

TEST(FurtherCameras, AreInTheDescriptionsForOtherPrograms) {
  const RobotModel robot = with_further_cameras(
      "[{name: rear, position_m: [-0.02, 0, 0.08], yaw_rad: 3, tilt_rad: 0.2},"
      " {name: left, module: 5, position_m: [0, 0.04, 0], tilt_rad: 0.1}]");
  for (const std::string& text : {urdf_model(robot), sdf_model(robot)}) {
    for (const char* frame : {"camera_optical", "camera_rear_optical", "camera_left_optical"})
      EXPECT_NE(text.find(frame), std::string::npos) << frame;
  }
  EXPECT_NE(sdf_model(robot).find(R"(<sensor name="camera_left" type="camera">)"), std::string::npos);
  // The link of a module behind the head begins at the joint ahead of it.
  const Eigen::Isometry3d X_LC = camera_in_link(robot, robot.further_cameras[1]);
  EXPECT_NEAR(X_LC.translation().x(), -0.5 * robot.module_length_m, 1e-12);
  EXPECT_NEAR(X_LC.translation().y(), 0.04, 1e-12);
}

}  // namespace
}  // namespace constrictor
