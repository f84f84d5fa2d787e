// The fast steps of perception compared with straightforward code that does the same: every byte must be equal.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

#include "perception/line_and_blob_detector.hpp"
#include "perception/line_view.hpp"
#include "perception/picture.hpp"
#include "ray_caster.hpp"
#include "robot/rotation.hpp"

namespace constrictor::perception {
namespace {

using testing::Arc;
using testing::Head;

cv::Mat random_image(int width, int height, int least, int most, std::uint32_t seed) {
  std::mt19937 generator(seed);
  cv::Mat image(height, width, CV_8UC3);
  for (int i = 0; i < 3 * width * height; ++i)
    image.data[i] = static_cast<std::uint8_t>(std::uniform_int_distribution<int>(least, most)(generator));
  return image;
}

/// Line, objects and zones in all colours, some of which the border of the image cuts, with noise.
std::vector<cv::Mat> pictures(const Head& head) {
  std::vector<cv::Mat> images;
  for (int i = 0; i < 8; ++i) {
    testing::Scene scene;
    if (i != 3) scene.line = Arc{{-0.2, 0.02 * i}, 0.1 * i - 0.4, 1.0 - 0.3 * i};
    scene.rounds = {{msg::kColourGreen, {0.6 + 0.1 * i, 0.5}, 0.09, 0.15},
                    {msg::kColourGreen, {0.6 + 0.1 * i, 0.5}, 0.3},
                    {msg::kColourRed, {1.1, -0.15 * i}, 0.08, 0.15},
                    {msg::kColourBlue, {1.3, 0.1}, 0.08, 0.15},
                    {msg::kColourYellow, {0.5, -0.4}, 0.12}};
    scene.noise_sd = 0.02 * (i % 4);
    scene.seed = static_cast<std::uint64_t>(i + 1);
    images.push_back(testing::draw(scene, testing::camera_info(), head));
  }
  return images;
}

GroundCamera camera_of(const Head& head) {
  return GroundCamera(testing::camera_info(), testing::orientation(head), head.height_m, {0.0445, 0.035});
}

bool equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

TEST(Reference, SmoothingEqualsTheGaussianBlurOfOpenCv) {
  Smoother smoother;
  cv::Mat smooth, expected;
  std::uint32_t seed = 0;
  // The smoother computes 16 bytes of a row at once (SIMD): the rows of some sizes are a multiple of 16 bytes long,
  // those of others are not. One smoother gets images of all sizes in turn, because it uses the memory of the previous
  // image again.
  for (const cv::Size size : {cv::Size(320, 240),
                              {32, 24},
                              {33, 25},
                              {37, 2},
                              {48, 30},
                              {160, 120},
                              {16, 3},
                              {4, 2},
                              {5, 7},
                              {3, 9},
                              {9, 1},
                              {1, 1}}) {
    for (const auto& [least, most] : {std::pair{0, 255}, {250, 255}, {0, 3}, {100, 140}}) {
      const cv::Mat rgb = random_image(size.width, size.height, least, most, ++seed);
      smoother.smooth(rgb, smooth);
      cv::GaussianBlur(rgb, expected, {7, 3}, 1.5, 0.7);
      EXPECT_TRUE(equal(smooth, expected)) << size << " values from " << least << " to " << most;
    }
  }
}

TEST(Reference, LabelsAreTheColoursOfThePixels) {
  PerceptionConfig strict;
  strict.min_chroma = 0.3;
  PerceptionConfig lenient;
  lenient.min_chroma = 0.01;
  lenient.min_saturation = 0.05;
  std::vector<cv::Mat> images = pictures({});
  for (std::uint32_t i = 0; i < 4; ++i) images.push_back(random_image(67, 40, 100, 110 + 40 * static_cast<int>(i), i));
  for (const PerceptionConfig& config : {PerceptionConfig{}, strict, lenient}) {
    const ColourClassifier classifier(config);
    Labels labels;
    for (const cv::Mat& image : images) {
      classifier.classify(image, labels);
      ASSERT_EQ(labels.image.size(), image.size());
      std::array<ColourExtent, msg::kColourCount> extents{};
      int wrong = 0;
      for (int v = 0; v < image.rows; ++v) {
        for (int u = 0; u < image.cols; ++u) {
          const auto& p = image.at<cv::Vec3b>(v, u);
          const std::uint8_t colour = classifier.colour_of(p[0], p[1], p[2]);
          wrong += labels.image.at<std::uint8_t>(v, u) != colour ? 1 : 0;
          if (colour != msg::kColourUnknown) extents[colour].add(u, v);
        }
      }
      EXPECT_EQ(wrong, 0);
      for (std::size_t colour = 0; colour < extents.size(); ++colour) {
        const ColourExtent &found = labels.extents[colour], &expected = extents[colour];
        EXPECT_EQ(std::tie(found.pixels, found.u_min, found.u_max, found.v_min, found.v_max),
                  std::tie(expected.pixels, expected.u_min, expected.u_max, expected.v_min, expected.v_max));
      }
    }
  }
}

TEST(Reference, RegionsOfAWindowAreThoseOfTheWholeImage) {
  const Head head{0.01, 0.02, 0.0, 0.035};
  const GroundCamera camera = camera_of(head);
  PerceptionConfig config;
  config.min_area_pixels = 4;  // many regions of equal area, whose order depends on the numbers of the components
  const ColourClassifier classifier(config);
  RegionBuffers buffers;
  Regions found;
  std::size_t regions = 0;
  for (const cv::Mat& image : pictures(head)) {
    Labels labels;
    classifier.classify(image, labels);
    find_regions(labels, camera, config, msg::kColourBlue, {}, buffers, found);
    for (ColourExtent& extent : labels.extents)
      extent = {extent.pixels, 0, 0, labels.image.cols - 1, labels.image.rows - 1};
    RegionBuffers whole_buffers;
    Regions whole;
    find_regions(labels, camera, config, msg::kColourBlue, {}, whole_buffers, whole);
    EXPECT_TRUE(equal(found.ids, whole.ids));
    ASSERT_EQ(found.regions.size(), whole.regions.size());
    regions += found.regions.size();
    for (std::size_t i = 0; i < found.regions.size(); ++i) {
      const Region &a = found.regions[i], &b = whole.regions[i];
      EXPECT_EQ(std::tie(a.colour, a.area, a.u_min, a.v_min, a.u_max, a.v_max, a.standing_first, a.standing_last),
                std::tie(b.colour, b.area, b.u_min, b.v_min, b.u_max, b.v_max, b.standing_first, b.standing_last));
      EXPECT_EQ(std::tie(a.standing_bottom, a.line), std::tie(b.standing_bottom, b.line));
    }
  }
  EXPECT_GT(regions, 40U);
}

TEST(Reference, LinePointsAreAllPixelsOfTheColourTheNearestFirst) {
  const Head head{0.01, 0.02, 0.0, 0.035};
  const GroundCamera camera = camera_of(head);
  const ColourClassifier classifier{PerceptionConfig{}};
  for (const cv::Mat& image : pictures(head)) {
    Labels labels;
    classifier.classify(image, labels);
    Regions none;  // nothing stands upright
    none.ids = cv::Mat::zeros(labels.image.size(), CV_8UC1);
    for (const std::uint8_t colour : {msg::kColourBlue, msg::kColourGreen}) {
      std::vector<Eigen::Vector2d> expected;
      for (int v = labels.image.rows - 1; v >= 0; --v) {
        for (int u = v % 2; u < labels.image.cols; u += 2) {  // a checkerboard
          if (labels.image.at<std::uint8_t>(v, u) != colour) continue;
          if (const auto p = camera.ground(u + 0.5, v + 0.5, 1.5)) expected.push_back(*p);
        }
      }
      std::stable_sort(expected.begin(), expected.end(),
                       [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
      EXPECT_EQ(LineView(labels, none, camera, colour).line_points(1.5), expected);
    }
  }
}

TEST(Reference, OwnHeadIsWhereARayPassesTheCapsule) {
  std::mt19937 generator(3);
  const auto random = [&](double from, double to) { return std::uniform_real_distribution<>(from, to)(generator); };
  int hits = 0, misses = 0;
  for (int i = 0; i < 300; ++i) {
    const double tilt = random(-0.5, 1.5);
    msg::CameraInfo info = testing::camera_info(320, 240, 1.5708, tilt);
    // Over the nose, over the middle, beside the head and inside of it.
    info.X_HC.position_m = {random(-0.1, 0.1), random(-0.05, 0.05), random(0.0, 0.08)};
    const HeadShape head{0.0445, 0.035};
    const GroundCamera camera(info, {1.0, 0.0, 0.0, 0.0}, 0.035, head);
    const auto& q = info.X_HC.orientation;
    const Eigen::Matrix3d R_HC = rotation_from(q);
    const Eigen::Vector3d p_HC(info.X_HC.position_m.x, info.X_HC.position_m.y, info.X_HC.position_m.z);
    for (int j = 0; j < 100; ++j) {
      const double u = random(0.0, 320.0), v = random(0.0, 240.0);
      const Eigen::Vector3d d =
          (R_HC * Eigen::Vector3d((u - info.cx) / info.fx, (v - info.cy) / info.fy, 1.0)).normalized();
      double s = std::clamp(p_HC.x(), -head.half_length_m, head.half_length_m), t = 0.0;
      for (int k = 0; k < 4; ++k) {
        t = std::max(0.0, (Eigen::Vector3d(s, 0.0, 0.0) - p_HC).dot(d));
        s = std::clamp(p_HC.x() + t * d.x(), -head.half_length_m, head.half_length_m);
      }
      const double distance_m = (p_HC + t * d - Eigen::Vector3d(s, 0.0, 0.0)).norm();
      const bool expected = distance_m < head.radius_m + 0.2 / info.fx;
      ASSERT_EQ(camera.own_body(u, v), expected) << "camera " << p_HC.transpose() << ", tilt " << tilt;
      ++(expected ? hits : misses);
    }
  }
  EXPECT_GT(hits, 3000);
  EXPECT_GT(misses, 3000);
}

TEST(Reference, LabelsOfBlobsAreInsideThePictureAndApartFromEachOther) {
  msg::CameraInfo info = testing::camera_info(320, 240, 1.0, 1.3);  // looks down: the horizon is not in the image
  const GroundCamera camera(info, {1.0, 0.0, 0.0, 0.0}, 0.035);
  const cv::Mat rgb(240, 320, CV_8UC3, cv::Scalar(0)), labels(240, 320, CV_8UC1, cv::Scalar(0));
  // The number of white pixels: on black ground only the labels are white.
  const auto white = [&](const std::vector<msg::Blob>& blobs) {
    msg::ObjectPercepts objects{};
    objects.blob_count = static_cast<std::uint8_t>(blobs.size());
    std::copy(blobs.begin(), blobs.end(), objects.blobs);
    cv::Mat picture, mask;
    draw_percepts(rgb, labels, camera, {}, objects, picture);
    cv::inRange(picture, cv::Scalar(255, 255, 255), cv::Scalar(255, 255, 255), mask);
    return cv::countNonZero(mask);
  };
  const auto blob = [](int u, int v) {
    msg::Blob one{};
    one.kind = msg::kBlobZone;
    one.colour = msg::kColourRed;
    one.range_m = 10.25;
    one.u_min = static_cast<decltype(one.u_min)>(u);
    one.v_min = static_cast<decltype(one.v_min)>(v);
    one.u_max = static_cast<decltype(one.u_max)>(u + 8);
    one.v_max = static_cast<decltype(one.v_max)>(v + 8);
    return one;
  };
  const int whole = white({blob(100, 100)});
  ASSERT_GT(whole, 50);
  for (const auto& [u, v] : std::vector<std::pair<int, int>>{{0, 0}, {311, 0}, {0, 231}, {311, 231}, {311, 100}})
    EXPECT_EQ(white({blob(u, v)}), whole) << "the label is cut at " << u << ", " << v;
  EXPECT_EQ(white({blob(100, 100), blob(104, 102), blob(110, 98), blob(100, 100)}), 4 * whole);
  EXPECT_EQ(white({blob(311, 0), blob(305, 3), blob(311, 231), blob(300, 228)}), 4 * whole);
}

TEST(Reference, PictureIsDimmedAndPaintedPixelByPixel) {
  constexpr std::array<std::array<int, 3>, msg::kColourCount> kPaint{
      {{}, {60, 200, 60}, {220, 60, 60}, {60, 110, 230}, {220, 200, 60}}};
  msg::CameraInfo info = testing::camera_info(75, 40, 1.0, 1.3);  // looks down: the horizon is not in the image
  const GroundCamera camera(info, {1.0, 0.0, 0.0, 0.0}, 0.035);
  const cv::Mat rgb = random_image(75, 40, 0, 255, 5);
  cv::Mat labels(40, 75, CV_8UC1, cv::Scalar(0)), picture;
  std::mt19937 generator(1);
  for (int i = 0; i < 400; ++i) labels.data[generator() % (40 * 75)] = static_cast<std::uint8_t>(generator() % 5);
  draw_percepts(rgb, labels, camera, {}, {}, picture);
  int wrong = 0;
  for (int i = 0; i < 40 * 75; ++i) {
    for (int c = 0; c < 3; ++c) {
      const int value = rgb.data[3 * i + c], label = labels.data[i];
      const int paint = kPaint[static_cast<std::size_t>(label)][static_cast<std::size_t>(c)];
      wrong += picture.data[3 * i + c] != (label == 0 ? value * 2 / 5 : (value + 2 * paint) / 4) ? 1 : 0;
    }
  }
  EXPECT_EQ(wrong, 0);
}

TEST(Reference, ResultDoesNotDependOnEarlierImages) {
  const Head head{0.01, 0.02, 0.0, 0.035};
  const GroundCamera camera = camera_of(head);
  LineAndBlobDetector used{PerceptionConfig{}};
  for (const cv::Mat& image : pictures(head)) {
    LineAndBlobDetector fresh{PerceptionConfig{}};
    const Percepts a = used.detect(image, camera, msg::kColourBlue), b = fresh.detect(image, camera, msg::kColourBlue);
    EXPECT_TRUE(equal(used.draw(image, camera, a.line, a.objects), fresh.draw(image, camera, b.line, b.objects)));
    ASSERT_EQ(a.line.point_count, b.line.point_count);
    for (int i = 0; i < a.line.point_count; ++i) {
      EXPECT_EQ(a.line.x_m[i], b.line.x_m[i]);
      EXPECT_EQ(a.line.y_m[i], b.line.y_m[i]);
    }
    ASSERT_EQ(a.objects.blob_count, b.objects.blob_count);
    for (int i = 0; i < a.objects.blob_count; ++i)
      EXPECT_EQ(a.objects.blobs[i].bearing_rad, b.objects.blobs[i].bearing_rad);
  }
}

}  // namespace
}  // namespace constrictor::perception
