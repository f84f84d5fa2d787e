#include "sim/camera_emulator/emulated_camera.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/physics/sensors.hpp"
#include "sim/scenario_loader/scenario_file.hpp"
#include "sim/world/world.hpp"
#include "support/project.hpp"

namespace constrictor::camera_emulator {
namespace {

class EmulatedCameraTest : public ::testing::Test {
 protected:
  EmulatedCameraTest()
      : robot_(load_robot(testing::robot_path("mamba"))),
        scenario_(load_scenario(testing::source_path("sim/scenarios/case_study.yaml"), 1)),
        camera_(make()) {
    const World world(robot_, scenario_);
    world_ = world_state(world);
  }
  [[nodiscard]] std::unique_ptr<EmulatedCamera> make(const CameraSettings& settings = {}) const {
    return std::make_unique<EmulatedCamera>(robot_, scenario_, 1, settings);
  }
  [[nodiscard]] cv::Mat picture() {
    const EmulatedFrame frame = camera_->expose(world_);
    return frame.jpeg ? cv::imdecode(*frame.jpeg, cv::IMREAD_COLOR) : cv::Mat();
  }
  void order(const std::string& line) { EXPECT_EQ(camera_->command(line), "") << line; }
  /// How sharp a picture is: the variance of its second derivative.
  static double sharpness(const cv::Mat& picture) {
    cv::Mat edges;
    cv::Laplacian(picture, edges, CV_64F);
    cv::Scalar mean, deviation;
    cv::meanStdDev(edges, mean, deviation);
    return deviation[0] * deviation[0];
  }

  RobotModel robot_;
  Scenario scenario_;
  std::unique_ptr<EmulatedCamera> camera_;
  msg::WorldState world_{};
};

TEST_F(EmulatedCameraTest, SeesTheLineInBlueWhereTheRobotLooks) {
  const cv::Mat seen = picture();
  ASSERT_EQ(seen.size(), cv::Size(320, 240));
  int blue = 0;
  for (int row = 120; row < 240; ++row) {
    for (int column = 0; column < 320; ++column) {
      const auto& p = seen.at<cv::Vec3b>(row, column);
      blue += p[0] > p[1] + 40 && p[0] > p[2] + 40 ? 1 : 0;
    }
  }
  EXPECT_GT(blue, 200);
}

TEST_F(EmulatedCameraTest, EqualWorldsAndCommandsGiveEqualPictures) {
  const auto other = make();
  for (int i = 0; i < 3; ++i) EXPECT_EQ(*camera_->expose(world_).jpeg, *other->expose(world_).jpeg) << i;
}

TEST_F(EmulatedCameraTest, EachFaultShowsInThePictures) {
  const cv::Mat sharp = picture();
  EXPECT_GT(cv::norm(sharp, picture(), cv::NORM_L1), 0.0) << "the noise makes frames different";
  order("black");
  EXPECT_LT(cv::mean(picture())[1], 8.0);
  order("mend");
  EXPECT_GT(cv::mean(picture())[1], 50.0);
  order("freeze");
  const cv::Mat frozen = picture();
  EXPECT_EQ(cv::norm(frozen, picture(), cv::NORM_L1), 0.0);
  order("mend");
  order("blur 4");
  EXPECT_LT(sharpness(picture()), 0.8 * sharpness(sharp));
  order("drop 1");
  EXPECT_EQ(camera_->expose(world_).jpeg, nullptr);
  order("mend");
  order("delay 0.3");
  order("jitter 0.1");
  for (int i = 0; i < 20; ++i) {
    const double delay_s = camera_->expose(world_).delay_s;
    EXPECT_GE(delay_s, 0.3);
    EXPECT_LE(delay_s, 0.4);
  }
  order("off");
  EXPECT_TRUE(camera_->faults().off);
  order("on");
  EXPECT_FALSE(camera_->faults().off);
}

TEST_F(EmulatedCameraTest, DropsAsManyFramesAsItIsTold) {
  order("drop 0.3");
  int dropped = 0;
  order("freeze");  // saves the drawing
  for (int i = 0; i < 1000; ++i) dropped += camera_->expose(world_).jpeg ? 0 : 1;
  EXPECT_NEAR(dropped, 300, 60);
}

TEST_F(EmulatedCameraTest, RefusesWhatItDoesNotUnderstand) {
  for (const std::string line :
       {"", "blurr 3", "blur", "blur x", "blur -1", "blur 3 4", "drop 2", "delay nan", "off 1"}) {
    const std::string refusal = camera_->command(line);
    EXPECT_NE(refusal.find("accepted"), std::string::npos) << line;
  }
  EXPECT_DOUBLE_EQ(camera_->faults().blur_px, 0.0);
}

TEST_F(EmulatedCameraTest, DrawsLargerPictures) {
  CameraSettings settings;
  settings.scale = 2;
  camera_ = make(settings);
  EXPECT_EQ(picture().size(), cv::Size(640, 480));
}

}  // namespace
}  // namespace constrictor::camera_emulator
