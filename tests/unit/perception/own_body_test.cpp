// The robot's own body in the image of the head's camera.
#include <gtest/gtest.h>

#include <vector>

#include "component/data_path.hpp"
#include "perception/line_and_blob_detector.hpp"
#include "ray_caster.hpp"
#include "robot/kinematics.hpp"

namespace constrictor {
namespace {

constexpr double kRadius_m = 0.035, kLength_m = 0.089;

RobotModel mamba() { return load_robot(data_path("components/lib/robot/mamba.yaml")); }

// A body that curls to the left comes into the view of the head's camera.
TEST(HeadCamera, KnowsWhichPixelsShowTheBodyThatCurlsAhead) {
  const RobotModel robot = mamba();
  const msg::CameraInfo info = testing::camera_info();
  const std::vector<double> straight(robot.joints.size(), 0.0);
  EXPECT_TRUE(perception::body_before_head(info, robot, straight).empty());
  EXPECT_TRUE(perception::body_before_head(info, robot, {}).empty()) << "the angles are unknown";

  std::vector<double> curled = straight;
  for (std::size_t joint = 0; joint < 12; joint += 2) curled[joint] = 0.7;
  const auto modules = module_poses(robot, curled, Eigen::Isometry3d::Identity());
  const perception::GroundCamera camera(info, {1, 0, 0, 0}, kRadius_m, {0.5 * kLength_m, kRadius_m},
                                        perception::body_before_head(info, robot, curled));
  ASSERT_TRUE(camera.sees_body());
  int seen = 0;
  for (std::size_t i = 2; i < modules.size(); ++i) {
    const Eigen::Vector3d middle = modules[i].translation() + Eigen::Vector3d(0.0, 0.0, kRadius_m);
    const auto pixel = camera.pixel(middle);
    if (!pixel || !camera.inside(*pixel)) continue;
    ++seen;
    EXPECT_TRUE(camera.own_body(pixel->x(), pixel->y())) << "module " << i;
    const auto above = camera.pixel(Eigen::Vector3d(middle + Eigen::Vector3d(0.0, 0.0, 0.1)));
    EXPECT_FALSE(above && camera.own_body(above->x(), above->y())) << "above module " << i;
  }
  EXPECT_GE(seen, 3);
  EXPECT_FALSE(camera.own_body(310.0, 150.0)) << "the right side of the image";
}

// The body lies across the left part of a zone. What remains looks as narrow as an object, and is none.
TEST(HeadCamera, TheRestOfAZoneBesideTheBodyIsNoObject) {
  const RobotModel robot = mamba();
  const msg::CameraInfo info = testing::camera_info();
  perception::LineAndBlobDetector detector{perception::PerceptionConfig{}};
  for (const double bend_rad : {0.55, 0.6, 0.65, 0.7, 0.75}) {
    std::vector<double> curled(robot.joints.size(), 0.0);
    for (std::size_t joint = 0; joint < 12; joint += 2) curled[joint] = bend_rad;
    const perception::GroundCamera camera(info, {1, 0, 0, 0}, kRadius_m, {0.5 * kLength_m, kRadius_m},
                                          perception::body_before_head(info, robot, curled));
    for (const double y_m : {-0.4, -0.3, -0.2, -0.1, 0.0, 0.1}) {
      testing::Scene scene;
      scene.rounds = {{msg::kColourRed, {0.7, y_m}, 0.4}};
      cv::Mat picture = testing::draw(scene, info, {});
      for (int v = 0; v < picture.rows; ++v) {
        for (int u = 0; u < picture.cols; ++u) {
          if (camera.sees_body() && camera.own_body(u + 0.5, v + 0.5)) picture.at<cv::Vec3b>(v, u) = {70, 70, 70};
        }
      }
      const perception::Percepts percepts = detector.detect(picture, camera, msg::kColourBlue);
      for (int i = 0; i < percepts.objects.blob_count; ++i)
        EXPECT_NE(percepts.objects.blobs[i].kind, msg::kBlobObject) << "bend " << bend_rad << ", zone at " << y_m;
      EXPECT_EQ(percepts.objects.obstacle_count, 0) << "the body is no obstacle";
    }
  }
}

}  // namespace
}  // namespace constrictor
