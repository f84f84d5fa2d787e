// Images compared with geometry: pin-hole equations, shadow construction, similar triangles.
#include "sim/render/renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <thread>

#include "unit/render/busy_scene.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;
using testing::busy_poses;
using testing::busy_scene;
using testing::scene_camera;

constexpr Rgb kRed{0.8F, 0.02F, 0.02F};

Eigen::Isometry3d at(const Vector3d& p) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() = p;
  return X;
}

struct Pixel {
  int r, g, b;
};

struct Picture {
  std::vector<std::uint8_t> rgb;
  int width = 0;
  int height = 0;
  [[nodiscard]] Pixel operator()(int u, int v) const {
    const std::size_t i =
        3 * (static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u));
    return {rgb[i], rgb[i + 1], rgb[i + 2]};
  }
  /// Centroid and count of the pixels that `wanted` accepts.
  struct Region {
    double u = 0, v = 0;
    int count = 0, v_min = 1 << 20, v_max = -1, u_min = 1 << 20, u_max = -1;
  };
  [[nodiscard]] Region find(const std::function<bool(const Pixel&)>& wanted) const {
    Region region;
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        if (!wanted((*this)(u, v))) continue;
        ++region.count;
        region.u += u + 0.5;
        region.v += v + 0.5;
        region.v_min = std::min(region.v_min, v);
        region.v_max = std::max(region.v_max, v);
        region.u_min = std::min(region.u_min, u);
        region.u_max = std::max(region.u_max, u);
      }
    }
    region.u /= region.count;
    region.v /= region.count;
    return region;
  }
};

bool is_red(const Pixel& p) { return p.r > p.g + 50 && p.r > p.b + 50; }

Picture take(Renderer& renderer, const ScenePoses& poses, const PinholeCamera& camera,
             const ShadowRegion& region = {}) {
  return {renderer.draw(poses, camera, region), camera.width, camera.height};
}

TEST(Renderer, ProjectsPointsByThePinholeEquations) {
  Scene scene;
  scene.objects = {{SolidShape::kBox, {0.02, 0.02, 0.02}, kRed}};
  scene.light.direction = Vector3d::UnitZ();
  scene.light.ambient = 0.9;  // every face is bright
  RenderOptions options;
  options.shadow_map_size = 0;
  Renderer renderer(scene, options);
  PinholeCamera camera{.width = 320, .height = 240, .fx = 170.0, .fy = 190.0, .cx = 150.5, .cy = 128.0};
  camera.X_WC = at({0.3, -0.2, 0.4}) * Eigen::AngleAxisd(0.7, Vector3d::UnitZ()) *
                Eigen::AngleAxisd(0.1, Vector3d::UnitY()) * Eigen::AngleAxisd(-1.8, Vector3d::UnitX());
  for (const Vector3d& p_C : {Vector3d(0, 0, 1), Vector3d(0.5, -0.2, 1), Vector3d(-0.6, 0.1, 1.1),
                              Vector3d(0.3, -0.25, 0.6), Vector3d(-0.2, -0.3, 0.8)}) {
    ASSERT_GT((camera.X_WC * p_C).z(), 0.05) << "the test point lies below the ground";
    const Picture picture = take(renderer, {{}, {at(camera.X_WC * p_C)}}, camera);
    const auto region = picture.find(is_red);
    ASSERT_GT(region.count, 3);
    EXPECT_NEAR(region.u, camera.fx * p_C.x() / p_C.z() + camera.cx, 0.5);
    EXPECT_NEAR(region.v, camera.fy * p_C.y() / p_C.z() + camera.cy, 0.5);
  }
}

TEST(Renderer, CylinderHasTheHeightOfSimilarTriangles) {
  Scene scene;
  constexpr double kRadius = 0.08;
  constexpr double kHeight = 0.15;
  scene.objects = {{SolidShape::kCylinder, {kRadius, kRadius, kHeight}, kRed}};
  scene.light.ambient = 0.9;
  Renderer renderer(scene, {});
  PinholeCamera camera = make_pinhole(320, 240, 1.0);
  camera.X_WC = look_at({0, 0, kHeight / 2}, {1, 0, kHeight / 2});
  for (const double distance : {0.6, 1.0, 1.5}) {
    const Picture picture = take(renderer, {{}, {at({distance, 0, kHeight / 2})}}, camera);
    const auto region = picture.find(is_red);
    EXPECT_NEAR(region.v_max - region.v_min + 1, camera.fy * kHeight / (distance - kRadius), 1.5);
    // The outline is bounded by the tangents from the eye.
    EXPECT_NEAR(region.u_max - region.u_min + 1,
                2 * camera.fx * kRadius / std::sqrt(distance * distance - kRadius * kRadius), 1.5);
  }
}

TEST(Renderer, LineHasItsWidthWhenSeenFromAbove) {
  Scene scene;
  scene.line_m = {{-2, 0.1}, {2, 0.1}};
  scene.line_width_m = 0.06;
  scene.line_colour = kRed;
  Renderer renderer(scene, {});
  PinholeCamera camera = make_pinhole(200, 200, 0.5);
  camera.X_WC = look_at({0, 0, 1.0}, {0, 0, 0});  // top of the image: +x, left: +y
  const auto region = take(renderer, {}, camera).find(is_red);
  EXPECT_NEAR(region.u_max - region.u_min + 1, camera.fx * 0.06, 1.01);
  EXPECT_NEAR(region.u, camera.cx - camera.fx * 0.1, 0.5);
  EXPECT_EQ(region.v_max - region.v_min + 1, 200);
}

TEST(Renderer, ShadowLiesWhereTheLightIsBlockedAndOnlyThere) {
  Scene scene;
  scene.objects = {{SolidShape::kCylinder, {0.05, 0.05, 0.3}, kRed}};
  scene.ground_colour = {0.4F, 0.4F, 0.4F};
  scene.light.direction =
      Vector3d(-1, 0, 1).normalized();  // the shadow falls along +x and is as long as the cylinder is high
  scene.light.ambient = 0.3;
  scene.light.intensity = 1.0;
  Renderer renderer(scene, {});
  PinholeCamera camera = make_pinhole(240, 240, 1.0);
  camera.X_WC = look_at({0.2, 0, 2.0}, {0.2, 0, 0});
  const Picture picture = take(renderer, {{}, {at({0, 0, 0.15})}}, camera);
  const auto brightness = [&](double x, double y) {  // mean over 5 x 5 pixels, because the ground has a pattern
    const Vector3d c = camera.X_WC.inverse() * Vector3d(x, y, 0);
    const int u = static_cast<int>(camera.fx * c.x() / c.z() + camera.cx);
    const int v = static_cast<int>(camera.fy * c.y() / c.z() + camera.cy);
    double sum = 0;
    for (int i = -2; i <= 2; ++i) {
      for (int j = -2; j <= 2; ++j) sum += picture(u + i, v + j).g;
    }
    return sum / 25;
  };
  const double lit = brightness(-0.3, 0.0);
  const double shadow = brightness(0.22, 0.0);
  // Radiances ambient and ambient + 0.8 cos 45°, shown with gamma 2.
  EXPECT_NEAR(shadow / lit, std::sqrt(0.3 / (0.3 + 0.8 * std::sqrt(0.5))), 0.05);
  EXPECT_GT(brightness(0.22, 0.12), 0.9 * lit);
  EXPECT_GT(brightness(0.45, 0.0), 0.9 * lit);  // the shadow ends at 0.30 + 0.05
}

TEST(Renderer, FramesAreEqualAcrossRenderersRunsAndThreads) {
  RenderOptions options;
  options.samples = 4;
  Renderer first(busy_scene(), options);
  const std::vector<std::uint8_t> reference = first.draw(busy_poses(), scene_camera(), {});
  // A renderer that has drawn other poses, another size and another region before.
  Renderer second(busy_scene(), options);
  ScenePoses others = busy_poses();
  others.X_WObject[0].translation().x() += 0.4;
  others.X_WModule.pop_back();
  (void)second.draw(others, scene_camera(96, 64), {{1.0, 1.0}, 1.0});
  EXPECT_EQ(second.draw(busy_poses(), scene_camera(), {}), reference);
  EXPECT_NE(second.draw(others, scene_camera(), {}), reference);
  std::vector<std::uint8_t> elsewhere;
  std::thread([&] { elsewhere = second.draw(busy_poses(), scene_camera(), {}); }).join();
  EXPECT_EQ(elsewhere, reference);
  EXPECT_EQ(first.draw(busy_poses(), scene_camera(), {}), reference);
}

TEST(Renderer, MultisamplingSmoothsEdges) {
  Scene scene;
  scene.line_m = {{-2, -0.5}, {2, 0.6}};
  scene.line_colour = kRed;
  scene.line_width_m = 0.4;
  const auto mixed = [&](int samples) {
    RenderOptions options;
    options.samples = samples;
    Renderer renderer(scene, options);
    PinholeCamera camera = make_pinhole(200, 200, 1.0);
    camera.X_WC = look_at({0, 0, 1.0}, {0, 0, 0});
    return take(renderer, {}, camera).find([](const Pixel& p) { return p.r - p.g > 20 && p.r - p.g < 120; }).count;
  };
  EXPECT_LT(mixed(1), 20);
  EXPECT_GT(mixed(4), 150);  // two edges, some 200 pixels long
}

TEST(Renderer, RobotIsGreyAndItsHeadTheBrightest) {
  Scene scene;
  Renderer renderer(scene, {});
  ScenePoses poses;
  for (int i = 0; i < 6; ++i) poses.X_WModule.push_back(at({-0.089 * i, 0, 0.035}));
  PinholeCamera camera = make_pinhole(320, 240, 0.8);
  camera.X_WC = look_at({-0.25, 0, 1.0}, {-0.25, 0, 0});
  const Picture picture = take(renderer, poses, camera);
  EXPECT_EQ(picture.find([](const Pixel& p) {
                     return std::max({p.r, p.g, p.b}) - std::min({p.r, p.g, p.b}) > 12;
                   })
                .count,
            0);
  const auto brightness = [&](double x) {
    const Vector3d c = camera.X_WC.inverse() * Vector3d(x, 0, 0.07);
    return picture(static_cast<int>(camera.fx * c.x() / c.z() + camera.cx),
                   static_cast<int>(camera.fy * c.y() / c.z() + camera.cy))
        .g;
  };
  EXPECT_GT(brightness(0.0), brightness(-0.089 * 2) + 20);
  EXPECT_GT(brightness(-0.089 * 2), brightness(-0.089) + 20);
}

}  // namespace
}  // namespace constrictor
