// The rectifier is compared with OpenCV's own, which has another implementation of the same model.
#include "video/rectifier.hpp"

#include <gtest/gtest.h>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace constrictor::video {
namespace {

CameraCalibration fish_eyed(std::vector<double> distortion) {
  CameraCalibration c{.width = 320, .height = 240, .fx = 180.0, .fy = 175.0, .cx = 163.0, .cy = 117.0};
  c.distortion = std::move(distortion);
  return c;
}

cv::Mat matrix_of(const CameraCalibration& c) {  // OpenCV's pixel centres lie at whole numbers
  return (cv::Mat_<double>(3, 3) << c.fx, 0, c.cx - 0.5, 0, c.fy, c.cy - 0.5, 0, 0, 1);
}

cv::Mat smooth_picture() {
  cv::Mat picture(240, 320, CV_8UC3);
  cv::RNG random(7);
  random.fill(picture, cv::RNG::UNIFORM, 0, 255);
  cv::GaussianBlur(picture, picture, {}, 4.0);
  cv::normalize(picture, picture, 0, 255, cv::NORM_MINMAX);
  return picture;
}

TEST(Rectifier, MovesPixelsAsOpenCvDoes) {
  for (const auto& k :
       {std::vector<double>{-0.3, 0.1, 0.001, -0.002}, std::vector<double>{-0.3, 0.1, 0.001, -0.002, 0.01},
        std::vector<double>{0.2, -0.1, 0.0, 0.0, 0.02, 0.1, 0.05, -0.01}}) {
    const CameraCalibration camera = fish_eyed(k);
    Rectifier rectifier(camera, 0, 0);
    const cv::Mat picture = smooth_picture();
    const cv::Mat found = rectifier.rectify(picture).clone();
    cv::Mat expected;
    cv::undistort(picture, expected, matrix_of(camera), cv::Mat(k));
    cv::cvtColor(expected, expected, cv::COLOR_BGR2RGB);
    cv::Mat difference;
    cv::absdiff(found, expected, difference);
    double most = 0.0;
    cv::minMaxLoc(difference.reshape(1), nullptr, &most);
    EXPECT_LE(most, 3.0) << "of 255, " << k.size() << " coefficients";
    cv::absdiff(found, picture, difference);
    EXPECT_GT(cv::mean(difference)[0], 3.0) << "the distortion must matter";
  }
}

TEST(Rectifier, AModelOfHalfTheSizeSeesTheSamePointsAtHalfThePlaces) {
  const CameraCalibration camera = fish_eyed({-0.3, 0.1, 0.001, -0.002});
  const Rectifier rectifier(camera, 160, 120);
  const std::vector<cv::Point2d> place = {{100.25, 60.5}};
  std::vector<cv::Point2d> whole;
  cv::undistortPoints(place, whole, matrix_of(camera), cv::Mat(camera.distortion));
  const CameraCalibration& half = rectifier.model();
  const Eigen::Vector2d at(half.fx * whole[0].x + half.cx, half.fy * whole[0].y + half.cy);
  const Eigen::Vector2d back = distorted(camera, half, at);
  EXPECT_NEAR(back.x() - 0.5, place[0].x, 0.05);
  EXPECT_NEAR(back.y() - 0.5, place[0].y, 0.05);
  EXPECT_NEAR(half.fx, 90.0, 1e-12);
  EXPECT_TRUE(half.distortion.empty());
}

TEST(Rectifier, OnlySwapsTheChannelsOfAPinHoleCamera) {
  Rectifier rectifier(fish_eyed({}), 0, 0);
  cv::Mat picture(240, 320, CV_8UC3, cv::Scalar(1, 2, 3));
  const cv::Mat& rgb = rectifier.rectify(picture);
  EXPECT_EQ(rgb.at<cv::Vec3b>(100, 100), cv::Vec3b(3, 2, 1));
}

TEST(Rectifier, RefusesOtherProportions) {
  Rectifier rectifier(fish_eyed({}), 0, 0);
  EXPECT_THROW(static_cast<void>(rectifier.rectify(cv::Mat(180, 320, CV_8UC3))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(rectifier.rectify(cv::Mat(240, 320, CV_8UC1))), std::invalid_argument);
  EXPECT_THROW(Rectifier(fish_eyed({}), 320, 320), std::invalid_argument);
}

}  // namespace
}  // namespace constrictor::video
