// The errors of percepts against what was asked: shares by the binomial law, factors by geometry, places in view.
#include "perception/percept_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "ray_caster.hpp"

namespace constrictor::perception {
namespace {

constexpr int kImages = 20000;
constexpr double kPeriod_s = 0.1;

const GroundCamera& camera() {
  static const GroundCamera the_camera(testing::camera_info(), testing::orientation({}), 0.035);
  return the_camera;
}

struct Percepts {
  msg::LinePercept line{};
  msg::ObjectPercepts objects{};
};

/// A straight line, a green object, and a red zone.
Percepts percepts() {
  Percepts p;
  p.line.visible = p.line.end_visible = true;
  p.line.colour = msg::kColourBlue;
  p.line.exposure_tick = 45;
  p.line.lookahead_m = 0.35;
  p.line.offset_m = 0.1;
  p.line.heading_rad = 0.2;
  p.line.curvature_1_m = 0.5;
  p.line.near_m = 0.2;
  p.line.far_m = p.line.end_distance_m = 1.0;
  p.line.point_count = 2;
  p.line.x_m[0] = 0.2, p.line.y_m[0] = 0.07;
  p.line.x_m[1] = 1.0, p.line.y_m[1] = 0.23;
  p.objects.exposure_tick = 45;
  p.objects.blob_count = 2;
  p.objects.blobs[0] = {
      msg::kColourGreen, msg::kBlobObject, 0.99, 0.3, 0.8, 0.17, 0.15, 0.05, false, false, false, false, 1, 2, 3, 4};
  p.objects.blobs[1] = {msg::kColourRed, msg::kBlobZone, 0.01,  -0.2,  1.1, 0.8, 0.0, 0.02,
                        false,           false,          false, false, 1,   2,   3,   4};
  return p;
}

Percepts with_errors(const PerceptErrorConfig& config, int image, double yaw_rad = 0.0, std::uint64_t seed = 5) {
  Percepts p = percepts();
  PerceptErrors(config, seed).apply(image * kPeriod_s, yaw_rad, camera(), p.line, p.objects);
  return p;
}

/// The number of `trials` independent events of probability p, within 4.5 standard deviations.
void expect_binomial(int count, int trials, double p) {
  EXPECT_NEAR(count, trials * p, 4.5 * std::sqrt(trials * p * (1 - p)) + 1e-9) << p;
}

TEST(PerceptErrors, AreOffByDefault) { EXPECT_FALSE(PerceptErrorConfig{}.any()); }

TEST(PerceptErrors, MissesTheShareThatWasAskedForEachPerceptByItself) {
  for (const double share : {0.05, 0.5, 1.0}) {
    PerceptErrorConfig config;
    config.missed_share = share;
    config.missed_line_share = share;
    int green = 0, red = 0, line = 0, green_and_red = 0, line_and_red = 0;
    for (int i = 0; i < kImages; ++i) {
      const Percepts p = with_errors(config, i);
      std::set<int> seen;
      for (int k = 0; k < p.objects.blob_count; ++k) seen.insert(p.objects.blobs[k].colour);
      const bool no_green = !seen.contains(msg::kColourGreen), no_red = !seen.contains(msg::kColourRed);
      green += no_green;
      red += no_red;
      line += !p.line.visible;
      green_and_red += no_green && no_red;
      line_and_red += !p.line.visible && no_red;
      if (!p.line.visible) {
        ASSERT_TRUE(std::isnan(p.line.offset_m) && p.line.point_count == 0 && !p.line.end_visible);
        ASSERT_EQ(p.line.exposure_tick, 45);
      }
    }
    for (const int count : {green, red, line}) expect_binomial(count, kImages, share);
    for (const int count : {green_and_red, line_and_red}) expect_binomial(count, kImages, share * share);
  }
}

TEST(PerceptErrors, AnErrorLastsAsLongAsItWasAskedFor) {
  PerceptErrorConfig config;
  config.missed_line_share = 0.5;
  config.lasts_s = 0.5;
  int missed = 0;
  for (int interval = 0; interval < kImages / 5; ++interval) {
    const bool first = with_errors(config, 5 * interval).line.visible;
    missed += !first;
    for (int i = 1; i < 5; ++i) ASSERT_EQ(with_errors(config, 5 * interval + i).line.visible, first) << interval;
  }
  expect_binomial(missed, kImages / 5, 0.5);
}

TEST(PerceptErrors, InventsObjectsOfBothColoursInViewAndInTheShareThatWasAskedFor) {
  PerceptErrorConfig config;
  config.false_share = 0.3;
  std::map<int, int> colours;
  for (int i = 0; i < kImages; ++i) {
    const Percepts p = with_errors(config, i, 0.01 * i);
    if (p.objects.blob_count == 2) continue;
    ASSERT_EQ(p.objects.blob_count, 3);
    double area = 1.0;
    for (int k = 0; k < 3; ++k) {
      const msg::Blob& blob = p.objects.blobs[k];
      ASSERT_LE(blob.area_fraction, area);  // the largest first
      area = blob.area_fraction;
      const bool known = (blob.bearing_rad == 0.3 && blob.range_m == 0.8) || blob.kind == msg::kBlobZone;
      if (known) continue;
      ASSERT_EQ(blob.kind, msg::kBlobObject);
      ++colours[blob.colour];
      // By geometry: the nearest point of the object lies within the box, in the image.
      const auto foot = camera().pixel(
          Eigen::Vector2d(blob.range_m * std::cos(blob.bearing_rad), blob.range_m * std::sin(blob.bearing_rad)));
      ASSERT_TRUE(foot.has_value());
      ASSERT_TRUE(camera().inside(*foot));
      ASSERT_GE(foot->x() + 1.0, blob.u_min);
      ASSERT_LE(foot->x(), blob.u_max + 1.0);
      ASSERT_NEAR(foot->y(), blob.v_max, 1.5);
      ASSERT_LT(blob.u_max, 320);
      ASSERT_LT(blob.v_max, 240);
    }
  }
  EXPECT_EQ(colours.size(), 2u);
  expect_binomial(colours[msg::kColourGreen] + colours[msg::kColourRed], kImages, 0.3);
  expect_binomial(colours[msg::kColourGreen], kImages, 0.15);
}

TEST(PerceptErrors, AnInventedObjectKeepsItsDirectionWhileTheHeadTurns) {
  PerceptErrorConfig config;
  config.false_share = 1.0;
  config.lasts_s = 1000.0;
  const auto bearing_at = [&](double yaw_rad) {
    const Percepts p = with_errors(config, 3, yaw_rad);
    for (int k = 0; k < p.objects.blob_count; ++k) {
      const msg::Blob& blob = p.objects.blobs[k];
      if (blob.kind == msg::kBlobObject && blob.bearing_rad != 0.3) return blob.bearing_rad;
    }
    return std::nan("");
  };
  const double start = bearing_at(0.0);
  int jumps = 0;
  for (double yaw = 0.0; yaw < 1.4; yaw += 0.02) {
    const double turned = start - yaw - bearing_at(yaw);  // 0, until it leaves the view and enters at the other side
    jumps += std::abs(turned) > 1e-9 && jumps == 0;
    if (jumps == 0) continue;
    EXPECT_NEAR(std::remainder(turned, 2.0 * 0.9 * std::numbers::pi / 4), 0.0, 1e-4);  // 90 % of 90 degrees
  }
  EXPECT_EQ(jumps, 1);
}

TEST(PerceptErrors, ARangeFactorIsThatOfACameraAtAWrongHeight) {
  // If the assumed height of the camera is 10 % too large, each ground point seems 10 % farther away.
  constexpr double kFactor = 1.1;
  msg::CameraInfo higher = testing::camera_info();
  for (double* value : {&higher.X_HC.position_m.x, &higher.X_HC.position_m.z}) *value *= kFactor;
  const GroundCamera believed(higher, testing::orientation({}), 0.035 * kFactor);
  PerceptErrorConfig config;
  config.range_factor = kFactor;
  const Percepts before = percepts(), after = with_errors(config, 0);
  for (int i = 0; i < 2; ++i) {
    const auto pixel = camera().pixel(Eigen::Vector2d(before.line.x_m[i], before.line.y_m[i]));
    const auto point = believed.ground(pixel->x(), pixel->y());
    EXPECT_NEAR(after.line.x_m[i], point->x(), 1e-9);
    EXPECT_NEAR(after.line.y_m[i], point->y(), 1e-9);
    const msg::Blob &blob = before.objects.blobs[i], &moved = after.objects.blobs[i];
    const Eigen::Vector2d direction(std::cos(blob.bearing_rad), std::sin(blob.bearing_rad));
    const auto foot = camera().pixel(Eigen::Vector2d(blob.range_m * direction));
    EXPECT_NEAR(believed.ground(foot->x(), foot->y())->norm(), moved.range_m, 1e-9);
    EXPECT_EQ(moved.bearing_rad, blob.bearing_rad);
    EXPECT_NEAR(moved.width_m / moved.range_m, blob.width_m / blob.range_m, 1e-12);  // the same angle
  }
  EXPECT_NEAR(after.line.curvature_1_m * after.line.lookahead_m, before.line.curvature_1_m * before.line.lookahead_m,
              1e-12);  // an angle
  EXPECT_NEAR(after.line.end_distance_m, kFactor, 1e-12);
  EXPECT_EQ(after.line.heading_rad, before.line.heading_rad);
}

TEST(PerceptErrors, NoiseHasTheStandardDeviationThatWasAskedFor) {
  PerceptErrorConfig config;
  config.range_noise = 0.1;
  config.line_noise_m = 0.02;
  double range = 0, range_square = 0, line = 0, line_square = 0, product = 0;
  for (int i = 0; i < kImages; ++i) {
    const Percepts p = with_errors(config, i);
    const double r = p.objects.blobs[0].range_m / 0.8 - 1.0, s = p.line.offset_m - 0.1;
    EXPECT_NEAR(p.line.y_m[1] - 0.23, s, 1e-12);  // the whole line moves
    EXPECT_EQ(p.line.x_m[1], 1.0);
    range += r, range_square += r * r, line += s, line_square += s * s;
    product += r / 0.1 * (p.objects.blobs[1].range_m / 1.1 - 1.0) / 0.1;
  }
  const double share = 1.0 / kImages, sigmas = 4.5 / std::sqrt(kImages);
  EXPECT_NEAR(range * share, 0.0, 0.1 * sigmas);
  EXPECT_NEAR(std::sqrt(range_square * share), 0.1, 0.1 * sigmas);
  EXPECT_NEAR(line * share, 0.0, 0.02 * sigmas);
  EXPECT_NEAR(std::sqrt(line_square * share), 0.02, 0.02 * sigmas);
  EXPECT_NEAR(product * share, 0.0, sigmas);  // object and zone are independent
}

TEST(PerceptErrors, WhatIsUnknownStaysUnknownAndAFullListStaysFull) {
  PerceptErrorConfig config;
  config.false_share = 1.0;
  config.range_noise = 0.5;
  config.range_factor = 1.2;
  Percepts p = percepts();
  p.objects.blobs[0].range_m = p.objects.blobs[0].width_m = p.line.end_distance_m = std::nan("");
  p.objects.blob_count = msg::kMaxBlobs;
  for (int i = 1; i < msg::kMaxBlobs; ++i) p.objects.blobs[i] = p.objects.blobs[1];
  PerceptErrors(config, 1).apply(0.0, 0.0, camera(), p.line, p.objects);
  EXPECT_TRUE(std::isnan(p.objects.blobs[0].range_m));
  EXPECT_TRUE(std::isnan(p.line.end_distance_m));
  EXPECT_EQ(p.objects.blob_count, msg::kMaxBlobs);
}

TEST(PerceptErrors, FollowFromTheSeed) {
  PerceptErrorConfig config;
  config.line_noise_m = 0.05;
  EXPECT_EQ(with_errors(config, 9).line.offset_m, with_errors(config, 9).line.offset_m);
  EXPECT_NE(with_errors(config, 9).line.offset_m, with_errors(config, 9, 0.0, 6).line.offset_m);
  EXPECT_NE(with_errors(config, 9).line.offset_m, with_errors(config, 10).line.offset_m);
}

}  // namespace
}  // namespace constrictor::perception
