#include "video/calibration.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "configuration/configuration.hpp"
#include "support/temporary_folder.hpp"

namespace constrictor::video {
namespace {

using testing::TemporaryFolder;

CameraModel robots_camera() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.p_HC = {0.03, 0.0, 0.05};
  camera.tilt_rad = 0.3;
  camera.horizontal_fov_rad = 1.2;
  return camera;
}

CameraCalibration example() {
  CameraCalibration c{.width = 640, .height = 480, .fx = 512.25, .fy = 511.5, .cx = 322.125, .cy = 238.375};
  c.distortion = {-0.31, 0.12, 0.0004, -0.0002, -0.02};
  c.X_HC = calibration_of(robots_camera()).X_HC;
  c.reprojection_error_px = 0.21;
  return c;
}

TEST(Calibration, ComesBackFromItsFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  const CameraCalibration written = example();
  std::ofstream(file) << calibration_text(written, true, "a test");
  const CameraCalibration read = load_calibration(file, CameraModel{});
  EXPECT_EQ(read.width, 640);
  EXPECT_NEAR(read.fx, written.fx, 1e-4);
  EXPECT_NEAR(read.cy, written.cy, 1e-4);
  EXPECT_EQ(read.distortion, written.distortion);
  EXPECT_TRUE(read.X_HC.isApprox(written.X_HC, 1e-6));
  EXPECT_NEAR(read.reprojection_error_px.value(), 0.21, 1e-9);
}

TEST(Calibration, WithoutAMountTakesThatOfTheRobotFile) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  std::ofstream(file) << calibration_text(example(), false, "a test");
  EXPECT_TRUE(load_calibration(file, robots_camera()).X_HC.isApprox(calibration_of(robots_camera()).X_HC, 1e-12));
}

TEST(Calibration, RobotsCameraLooksDownByItsTilt) {
  const CameraCalibration c = calibration_of(robots_camera());
  const Eigen::Vector3d view_H = c.X_HC.linear().col(2);
  EXPECT_NEAR(std::asin(-view_H.z()), 0.3, 1e-12);
  EXPECT_NEAR(2.0 * std::atan(0.5 * c.width / c.fx), 1.2, 1e-12);
}

TEST(Calibration, RefusesWhatIsNoCalibration) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "camera.yaml";
  const std::string good = calibration_text(example(), true, "a test");
  const auto refusal = [&](const std::string& what, const std::string& with) -> std::string {
    std::string text = good;
    text.replace(text.find(what), what.size(), with);
    std::ofstream(file) << text;
    try {
      static_cast<void>(load_calibration(file, CameraModel{}));
    } catch (const ConfigurationError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(refusal("fx: 512.2500", "fx: 0").find("accepted 1 to"), std::string::npos);
  EXPECT_NE(refusal("width: 640", "width: 100000").find("image.width"), std::string::npos);
  EXPECT_NE(refusal("-0.31, 0.12, ", "").find("accepted 0, 4, 5 or 8"), std::string::npos);
  EXPECT_NE(refusal("orientation_wxyz: [", "orientation_wxyz: [0.9, 0.9, 0, 0] # [").find("length"), std::string::npos);
  EXPECT_NE(refusal("mount:", "mounting:").find("mounting"), std::string::npos);
}

TEST(Calibration, FitsOtherSizesOfTheSameProportions) {
  const CameraCalibration half = example().scaled_to(320, 240);
  EXPECT_NEAR(half.fx, 256.125, 1e-9);
  EXPECT_NEAR(half.cx, 161.0625, 1e-9);
  EXPECT_THROW(static_cast<void>(example().scaled_to(320, 180)), std::invalid_argument);
}

}  // namespace
}  // namespace constrictor::video
