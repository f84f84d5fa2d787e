// The reflection of the light in a glossy ground, compared with the mirror law and with formulas that are written down
// independently of the shader.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "sim/render/renderer.hpp"
#include "unit/render/busy_scene.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;
using testing::busy_poses;
using testing::busy_scene;
using testing::scene_camera;

constexpr int kWidth = 240, kHeight = 180;

/// Bare, dark ground: 8 bits show the reflection alone, and nothing is saturated.
Scene dark_scene(const Vector3d& to_light, double gloss) {
  Scene scene;
  scene.ground_colour = {0.0F, 0.0F, 0.0F};
  scene.light.direction = to_light.normalized();
  scene.light.ambient = 0.0;
  scene.ground_gloss = gloss;
  return scene;
}

PinholeCamera camera_over_ground() {
  PinholeCamera camera = make_pinhole(kWidth, kHeight, 1.0);
  camera.X_WC = look_at({0.0, 0.0, 1.0}, {1.0, 0.0, 0.0});
  return camera;
}

std::vector<std::uint8_t> draw(const Scene& scene, const ScenePoses& poses = {},
                               const PinholeCamera& camera = camera_over_ground()) {
  Renderer renderer(scene, {});
  return renderer.draw(poses, camera, {});
}

/// Linear radiance of a pixel's green channel: the gamma of the display is a square root.
double radiance(const std::vector<std::uint8_t>& rgb, int u, int v) {
  const double value = rgb[static_cast<std::size_t>(3 * (v * kWidth + u) + 1)] / 255.0;
  return value * value;
}

/// The point of the ground that a pixel shows.
Vector3d ground_at(const PinholeCamera& camera, int u, int v) {
  const Vector3d ray =
      camera.X_WC.linear() * Vector3d((u + 0.5 - camera.cx) / camera.fx, (v + 0.5 - camera.cy) / camera.fy, 1.0);
  const Vector3d eye = camera.X_WC.translation();
  return eye - ray * (eye.z() / ray.z());
}

TEST(Glare, IsBrightestWhereTheMirrorLawSays) {
  // From above, Fresnel's factor is nearly the same everywhere, so that the lobe alone decides.
  const PinholeCamera camera = camera_over_ground();
  for (const Vector3d& to_light : {Vector3d(1.0, 0.0, 1.0), Vector3d(0.9, 0.3, 1.1), Vector3d(1.1, -0.35, 1.3)}) {
    const std::vector<std::uint8_t> rgb = draw(dark_scene(to_light, 2.0));
    double sum = 0.0, u_sum = 0.0, v_sum = 0.0;
    int brightest = 0;
    for (std::size_t i = 1; i < rgb.size(); i += 3) brightest = std::max<int>(brightest, rgb[i]);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        if (rgb[static_cast<std::size_t>(3 * (v * kWidth + u) + 1)] < brightest) continue;
        sum += 1.0;
        u_sum += u + 0.5;
        v_sum += v + 0.5;
      }
    }
    // The mirror law: the light seems to come from below the ground, at the same angle.
    const Vector3d p_C = camera.X_WC.inverse() * Vector3d(to_light.x() / to_light.z(), to_light.y() / to_light.z(), 0);
    EXPECT_GT(brightest, 60);
    EXPECT_LT(brightest, 255);
    EXPECT_NEAR(u_sum / sum, camera.cx + camera.fx * p_C.x() / p_C.z(), 3.0);
    EXPECT_NEAR(v_sum / sum, camera.cy + camera.fy * p_C.y() / p_C.z(), 8.0);
  }
}

TEST(Glare, HasTheStrengthOfTheNormalisedLobe) {
  const Vector3d to_light = Vector3d(0.9, 0.2, 0.6).normalized();
  const PinholeCamera camera = camera_over_ground();
  const std::vector<std::uint8_t> rgb = draw(dark_scene(to_light, 1.0));
  int compared = 0;
  for (int v = 30; v < kHeight; v += 7) {
    for (int u = 3; u < kWidth; u += 7) {
      const Vector3d p = ground_at(camera, u, v);
      const Vector3d to_eye = camera.X_WC.translation() - p;
      if (to_eye.norm() > 4.0) continue;  // farther away, the haze is seen
      const Vector3d half = (to_light + to_eye.normalized()).normalized();
      const double slope_rad = std::acos(half.z()), incidence_rad = std::acos(half.dot(to_light));
      const double fresnel = 0.04 + 0.96 * std::pow(1.0 - std::cos(incidence_rad), 5.0);
      const double expected = 9.0 * std::pow(std::cos(slope_rad), 64.0) * fresnel * 0.8 * to_light.z();
      if (expected > 0.9) continue;
      EXPECT_NEAR(radiance(rgb, u, v), expected, 0.012 + 0.02 * expected) << u << ", " << v;
      ++compared;
    }
  }
  EXPECT_GT(compared, 200);
}

TEST(Glare, GrowsWithTheGlossEverywhere) {
  Scene scene = busy_scene();
  std::vector<std::uint8_t> before = draw(scene, busy_poses(), scene_camera());
  for (const double gloss : {0.2, 1.0, 4.0}) {
    scene.ground_gloss = gloss;
    const std::vector<std::uint8_t> now = draw(scene, busy_poses(), scene_camera());
    EXPECT_NE(now, before);
    for (std::size_t i = 0; i < now.size(); ++i) ASSERT_GE(now[i], before[i]) << "gloss " << gloss;
    before = now;
  }
}

TEST(Glare, IsNotSeenInAShadow) {
  Scene scene = dark_scene({-1.0, 0.0, 1.0}, 4.0);  // the shadow falls along +x
  scene.objects = {{SolidShape::kCylinder, {0.1, 0.1, 0.6}, {0.0F, 0.0F, 0.0F}}};
  ScenePoses poses;
  poses.X_WObject = {Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.3))};
  PinholeCamera camera = make_pinhole(kWidth, kHeight, 0.8);
  camera.X_WC = look_at({1.5, 0.0, 1.3}, {0.2, 0.0, 0.0});
  Renderer renderer(scene, {});
  const std::vector<std::uint8_t> rgb = renderer.draw(poses, camera, {});
  const auto seen = [&](double x, double y) {
    const Vector3d p_C = camera.X_WC.inverse() * Vector3d(x, y, 0.0);
    return radiance(rgb, static_cast<int>(camera.cx + camera.fx * p_C.x() / p_C.z()),
                    static_cast<int>(camera.cy + camera.fy * p_C.y() / p_C.z()));
  };
  EXPECT_LT(seen(0.3, 0.0), 0.004);
  EXPECT_GT(seen(0.3, 0.25), 0.05);
  EXPECT_GT(seen(0.3, -0.25), 0.05);
}

TEST(Glare, DoesNotDependOnWhatTheRendererLeavesOut) {
  Scene scene = busy_scene();
  scene.ground_gloss = 1.0;
  RenderOptions everything;
  everything.draw_everything = true;
  Renderer all(scene, everything);
  EXPECT_EQ(draw(scene, busy_poses(), scene_camera()), all.draw(busy_poses(), scene_camera(), {}));
}

}  // namespace
}  // namespace constrictor
