// The camera's images and annotations as viewers see them, against bytes and pixels computed otherwise.
#include "views/camera_views.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <vector>

namespace constrictor::views {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

msg::Pose3 message_of(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d& p = pose.translation();
  return {{p.x(), p.y(), p.z()}, {q.w(), q.x(), q.y(), q.z()}};
}

/// A head that is pitched, rolled and turned, with a camera that looks ahead and down.
struct Head {
  Eigen::Isometry3d X_WH = Eigen::Translation3d(0.7, -0.4, 0.06) * Eigen::AngleAxisd(0.8, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitX());
  Eigen::Isometry3d X_HC = Eigen::Translation3d(0.05, 0.0, 0.04) *
                           Eigen::AngleAxisd(-std::numbers::pi / 2, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(-std::numbers::pi / 2 - 0.3, Eigen::Vector3d::UnitX());
};

msg::CameraInfo lens() {
  msg::CameraInfo info{};
  info.width = 320;
  info.height = 240;
  info.fx = 210.0;
  info.fy = 205.0;
  info.cx = 161.0;
  info.cy = 118.5;
  info.X_HC = message_of(Head().X_HC);
  return info;
}

Newest line_ahead() {
  Newest newest;
  newest.camera = lens();
  newest.heads[40] = message_of(Head().X_WH);
  msg::LinePercept line{};
  line.exposure_tick = 40;
  line.visible = true;
  line.colour = msg::kColourBlue;
  line.point_count = 3;
  for (int i = 0; i < 3; ++i) {
    line.x_m[i] = 0.3 + 0.2 * i;
    line.y_m[i] = 0.02 * i * i - 0.03;
  }
  newest.line = line;
  return newest;
}

TEST(CameraViews, AnImageHasTheBytesOfSensorMsgsImage) {
  std::vector<std::uint8_t> pixels(2 * 3 * 3);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = static_cast<std::uint8_t>(i);
  msg::CameraImage image{};
  image.width = 3;
  image.height = 2;
  image.data._buffer = pixels.data();
  image.data._length = static_cast<std::uint32_t>(pixels.size());
  const auto cdr = ros_image(image, "head", 7'000'000'009);
  ASSERT_TRUE(cdr);
  // Offsets behind the encapsulation: stamp 0, frame 8 ("head" and 0 at 12), height 20, width 24, encoding 28 ("rgb8"
  // and 0 at 32), is_bigendian 37, step 40, number of bytes 44, bytes 48.
  const auto u32 = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, cdr->data() + 4 + at, 4);
    return value;
  };
  ASSERT_EQ(cdr->size(), 4u + 48 + 18);
  EXPECT_EQ(u32(0), 7u);
  EXPECT_EQ(u32(4), 9u);
  EXPECT_EQ(u32(8), 5u);
  EXPECT_STREQ(cdr->data() + 4 + 12, "head");
  EXPECT_EQ(u32(20), 2u);
  EXPECT_EQ(u32(24), 3u);
  EXPECT_STREQ(cdr->data() + 4 + 32, "rgb8");
  EXPECT_EQ(u32(40), 9u);
  EXPECT_EQ(u32(44), 18u);
  EXPECT_EQ(cdr->back(), 17);
  image.data._length = 17;
  EXPECT_FALSE(ros_image(image, "head", 0)) << "its bytes do not fit its size";
}

TEST(CameraViews, TheLineIsDrawnWhereOpenCvProjectsIt) {
  const Newest newest = line_ahead();
  const Head head;
  const double yaw_rad = std::atan2(head.X_WH.linear()(1, 0), head.X_WH.linear()(0, 0));
  std::vector<cv::Point3d> points_W;
  for (int i = 0; i < 3; ++i) {
    const double x = newest.line->x_m[i], y = newest.line->y_m[i];
    points_W.emplace_back(head.X_WH.translation().x() + std::cos(yaw_rad) * x - std::sin(yaw_rad) * y,
                          head.X_WH.translation().y() + std::sin(yaw_rad) * x + std::cos(yaw_rad) * y, 0.0);
  }
  const Eigen::Isometry3d X_CW = (head.X_WH * head.X_HC).inverse();
  cv::Mat rotation, turn, shift;
  cv::eigen2cv(Eigen::Matrix3d(X_CW.linear()), rotation);
  cv::eigen2cv(Eigen::Vector3d(X_CW.translation()), shift);
  cv::Rodrigues(rotation, turn);
  const cv::Matx33d K(210.0, 0, 161.0, 0, 205.0, 118.5, 0, 0, 1);
  std::vector<cv::Point2d> expected;
  cv::projectPoints(points_W, turn, shift, K, cv::noArray(), expected);

  const auto annotations = image_annotations(newest, 3'000'000'004);
  ASSERT_EQ(annotations.at("points").size(), 1u);
  const auto& drawn = annotations.at("points").at(0);
  EXPECT_EQ(drawn.at("timestamp").at("nsec"), 4);
  ASSERT_EQ(drawn.at("points").size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(drawn.at("points").at(i).at("x").get<double>(), expected[i].x, 1e-6) << i;
    EXPECT_NEAR(drawn.at("points").at(i).at("y").get<double>(), expected[i].y, 1e-6) << i;
    EXPECT_TRUE(expected[i].x > 0 && expected[i].x < 320 && expected[i].y > 0 && expected[i].y < 240) << "in view";
  }
}

TEST(CameraViews, ALineWhosePlaceIsNotKnownIsLeftOut) {
  Newest newest = line_ahead();
  newest.line->exposure_tick = 41;
  EXPECT_TRUE(image_annotations(newest, 0).at("points").empty()) << "no pose of that tick";
  newest = line_ahead();
  newest.camera.reset();
  EXPECT_TRUE(image_annotations(newest, 0).at("points").empty());
  newest = line_ahead();
  newest.line->visible = false;
  EXPECT_TRUE(image_annotations(newest, 0).at("points").empty());
  newest = line_ahead();
  for (double& x : newest.line->x_m) x = -2.0;
  EXPECT_TRUE(image_annotations(newest, 0).at("points").empty()) << "behind the camera";
}

TEST(CameraViews, ABoxContainsAllPixelsOfItsObject) {
  Newest newest;
  msg::ObjectPercepts blobs{};
  blobs.blob_count = 2;
  msg::Blob& object = blobs.blobs[0];
  object.colour = msg::kColourRed;
  object.kind = msg::kBlobObject;
  object.range_m = 0.517;
  object.u_min = 10;
  object.u_max = 19;
  object.v_min = 30;
  object.v_max = 59;
  blobs.blobs[1].kind = msg::kBlobZone;
  blobs.blobs[1].range_m = kNan;
  newest.blobs = blobs;
  const auto annotations = image_annotations(newest, 0);
  ASSERT_EQ(annotations.at("points").size(), 2u);
  std::vector<double> u, v;
  for (const auto& corner : annotations.at("points").at(0).at("points")) {
    u.push_back(corner.at("x"));
    v.push_back(corner.at("y"));
  }
  EXPECT_EQ(u, (std::vector<double>{10, 20, 20, 10}));
  EXPECT_EQ(v, (std::vector<double>{30, 30, 60, 60}));
  EXPECT_EQ(annotations.at("texts").at(0).at("text"), "red object 0.52 m");
  EXPECT_EQ(annotations.at("texts").at(1).at("text"), "unknown zone") << "without a range";
}

TEST(CameraViews, TheLensIsThatOfThePinHole) {
  const auto calibration = camera_calibration(lens(), 0);
  const cv::Matx33d K(calibration.at("K").get<std::vector<double>>().data());
  const cv::Matx34d P(calibration.at("P").get<std::vector<double>>().data());
  const cv::Vec3d seen = K * cv::Vec3d(0.1, -0.2, 1.0), rectified = P * cv::Vec4d(0.1, -0.2, 1.0, 1.0);
  EXPECT_EQ(seen, cv::Vec3d(210.0 * 0.1 + 161.0, 205.0 * -0.2 + 118.5, 1.0));
  EXPECT_EQ(rectified, seen);
  EXPECT_EQ(calibration.at("frame_id"), kCameraFrame);
  EXPECT_EQ(calibration.at("width"), 320);
}

}  // namespace
}  // namespace constrictor::views
