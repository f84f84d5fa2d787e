// The renderer leaves out bodies that cannot change the image. Its frames are compared with frames of everything.
#include "sim/render/visibility.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "sim/render/renderer.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

class Dice {
 public:
  double operator()(double from, double to) { return std::uniform_real_distribution<double>(from, to)(generator_); }
  Vector3d vector(const Vector3d& from, const Vector3d& to) {
    return {(*this)(from.x(), to.x()), (*this)(from.y(), to.y()), (*this)(from.z(), to.z())};
  }

 private:
  std::mt19937 generator_{7};
};

/// A line in bends, zones, objects and walls around the origin, under light from any side, also from low over the
/// ground.
Scene random_scene(Dice& dice) {
  Scene scene;
  const double bend = dice(-0.5, 0.5);
  for (int i = 0; i <= 120; ++i) scene.line_m.emplace_back(0.05 * i - 2.0, bend * std::sin(0.05 * i));
  scene.line_colour = colour_reflectance(3);
  for (int i = 0; i < 3; ++i)
    scene.zones.push_back({dice.vector({-3, -3, 0}, {3, 3, 0}).head<2>(), dice(0.1, 0.5), colour_reflectance(1)});
  for (int i = 0; i < 6; ++i) {
    const double radius = dice(0.05, 0.1);
    scene.objects.push_back({SolidShape::kCylinder, {radius, radius, dice(0.1, 0.2)}, colour_reflectance(2)});
  }
  scene.obstacles = {{SolidShape::kBox, {0.1, 1.0, 0.3}, colour_reflectance(0)}};
  scene.X_WObstacle = {Eigen::Isometry3d(Eigen::Translation3d(dice.vector({-2, -2, 0.15}, {2, 2, 0.15})))};
  scene.light.direction = dice.vector({-1, -1, 0.1}, {1, 1, 1}).normalized();
  return scene;
}

/// A snake whose head is near the origin, with any heading and bends.
ScenePoses random_poses(Dice& dice) {
  ScenePoses poses;
  double heading = dice(-3.0, 3.0);
  const double amplitude = dice(0.0, 0.6), phase = dice(0.0, 6.0);
  Vector3d p(dice(-0.5, 0.5), dice(-0.5, 0.5), 0.035);
  for (int i = 0; i < 24; ++i) {
    Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
    X.translate(p).rotate(Eigen::AngleAxisd(heading, Vector3d::UnitZ()));
    X.rotate(Eigen::AngleAxisd(dice(-0.2, 0.2), Vector3d::UnitY()));
    poses.X_WModule.push_back(X);
    p -= 0.089 * Vector3d(std::cos(heading), std::sin(heading), 0.0);
    heading += amplitude * std::sin(0.5 * i + phase);
  }
  for (int i = 0; i < 6; ++i)
    poses.X_WObject.emplace_back(Eigen::Translation3d(dice.vector({-2, -2, 0.075}, {2, 2, 0.2})));
  return poses;
}

/// Number of pixels that differ.
std::size_t differences(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  std::size_t count = a.size() == b.size() ? 0 : a.size();
  for (std::size_t i = 0; count < a.size() && i < a.size(); ++i) count += a[i] != b[i] ? 1 : 0;
  return count;
}

TEST(Visibility, FramesAreEqualToFramesOfEverything) {
  Dice dice;
  for (int round = 0; round < 6; ++round) {
    const Scene scene = random_scene(dice);
    RenderOptions options;
    options.shadow_map_size = round % 2 == 0 ? 512 : 64;  // coarse maps look farther beside a place
    options.shadow_taps = round % 3 == 0 ? 3 : 1;
    Renderer fast(scene, options);
    options.draw_everything = true;
    Renderer complete(scene, options);
    for (int frame = 0; frame < 12; ++frame) {
      const ScenePoses poses = random_poses(dice);
      PinholeCamera camera = make_pinhole(160, 120, dice(0.5, 1.8));
      const Vector3d eye = poses.X_WModule[0].translation() + Vector3d(0, 0, frame % 2 == 0 ? 0.05 : dice(0.2, 1.0));
      camera.X_WC = look_at(eye, eye + dice.vector({-1, -1, -0.6}, {1, 1, 0.1}));
      const ShadowRegion region{dice.vector({-2, -2, 0}, {2, 2, 0}).head<2>(), dice(0.5, 3.0)};
      EXPECT_EQ(differences(fast.draw(poses, camera, region), complete.draw(poses, camera, region)), 0U)
          << "round " << round << ", frame " << frame;
    }
  }
}

TEST(Visibility, TheTipOfALongShadowIsDrawnWhereItsBodyIsOutOfView) {
  Scene scene;
  scene.objects = {{SolidShape::kBox, {0.1, 0.1, 0.3}, colour_reflectance(2)}};
  scene.light.direction = Vector3d(-1.0, 0.0, 0.15).normalized();  // the shadow is 2 m long and falls along +x
  PinholeCamera camera = make_pinhole(160, 120, 0.3);
  camera.X_WC = look_at({1.95, 0.0, 1.0}, {1.95, 0.0, 0.0});
  const ScenePoses poses{{}, {Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 0.15))}};
  const ShadowRegion region{{1.0, 0.0}, 2.0};
  RenderOptions options;
  const std::vector<std::uint8_t> frame = Renderer(scene, options).draw(poses, camera, region);
  const std::vector<std::uint8_t> bare = Renderer(scene, options).draw({}, camera, region);
  EXPECT_GT(differences(frame, bare), 1000U);
  options.draw_everything = true;
  EXPECT_EQ(differences(frame, Renderer(scene, options).draw(poses, camera, region)), 0U);
}

TEST(Visibility, LeavesOutWhatLiesBehindTheCameraOrBesideTheView) {
  PinholeCamera camera = make_pinhole(320, 240, 1.5708);  // sees 45 degrees to both sides
  camera.X_WC = look_at({0, 0, 1}, {1, 0, 1});
  const ViewVolume view(camera, 0.01);
  EXPECT_TRUE(view.may_contain({2, 0, 1}, 0.1));
  EXPECT_FALSE(view.may_contain({-0.2, 0, 1}, 0.1));
  EXPECT_TRUE(view.may_contain({-0.05, 0, 1}, 0.1));
  // The distance from the plane of the border is (y - x) / sqrt(2).
  EXPECT_FALSE(view.may_contain({1, 1.2, 1}, 0.13));
  EXPECT_TRUE(view.may_contain({1, 1.2, 1}, 0.15));
  EXPECT_TRUE(view.may_contain({-1, 0, 1}, {1, 0, 1}, 0.1));  // moves into the view
}

TEST(Visibility, AShadowCountsWhereTheLightThrowsIt) {
  PinholeCamera camera = make_pinhole(320, 240, 1.0);
  camera.X_WC = look_at({0, 0, 0.5}, {1, 0, 0});
  const ViewVolume view(camera, 0.01);
  Eigen::Matrix4f map = Eigen::Matrix4f::Identity() * 0.1F;  // covers 10 m to each side
  const Vector3d behind(-1.0, 0.0, 0.5);
  EXPECT_TRUE(ShadowVolume(map, Vector3d(-1, 0, 0.2), 0.0).may_shade(view, behind, 0.1));  // falls ahead
  EXPECT_FALSE(ShadowVolume(map, Vector3d(1, 0, 0.2), 0.0).may_shade(view, behind, 0.1));  // falls back
  EXPECT_FALSE(ShadowVolume(map, Vector3d(0, 0, 1), 0.0).may_shade(view, behind, 0.1));    // falls below
  EXPECT_TRUE(ShadowVolume(map, Vector3d(0, 0, 1), 0.0).may_shade(view, {1, 0, 0.1}, 0.1));
  map *= 20.0F;  // covers 0.5 m
  EXPECT_FALSE(ShadowVolume(map, Vector3d(0, 0, 1), 0.0).may_shade(view, {1, 0, 0.1}, 0.1));
}

TEST(Visibility, TheGroundIsShadedOnlyWhereALightRayThroughABodyMeetsIt) {
  PinholeCamera camera = make_pinhole(320, 240, 1.5708);  // fx = fy = 160
  camera.X_WC = Eigen::Isometry3d(Eigen::Translation3d(0, 0, 2));
  camera.X_WC.linear() << 1, 0, 0, 0, -1, 0, 0, 0, -1;  // looks down: u to +x, v to -y; 80 pixels for 1 m
  Eigen::Matrix4f map = Eigen::Matrix4f::Identity();
  map(0, 2) = 1.0F;  // the light falls along +x and down at 45 degrees: a body at height h shades x + h
  map(2, 2) = 0.1F;
  ShadowedGround ground(camera, 0.01, map, 0.01);
  EXPECT_TRUE(ground.pixels().empty());
  ground.add({0.0, 0.5, 0.5}, 0.1);
  PixelBox box = ground.pixels();
  // The centre of the shadow is at (0.5, 0.5): pixel (200, 80). The sphere of 0.1 m reaches at most 0.1 * 1.42 m there.
  EXPECT_LE(box.left, 192);
  EXPECT_GE(box.right, 208);
  EXPECT_LE(box.top, 72);
  EXPECT_GE(box.bottom, 88);
  EXPECT_GE(box.left, 200 - 24);
  EXPECT_LE(box.right, 200 + 24);
  EXPECT_GE(box.top, 80 - 24);
  EXPECT_LE(box.bottom, 80 + 24);
  ground.add({0.5, 0.5, 5.0}, 0.1);  // its shadow lies out of view
  EXPECT_EQ(ground.pixels().left, box.left);
  EXPECT_EQ(ground.pixels().right, 320);
  // Where the ground comes near to the camera, the shadow reaches to the border of the image.
  camera.X_WC = look_at({0, 0, 0.05}, {1, 0, 0.0});
  ShadowedGround near(camera, 0.01, Eigen::Matrix4f::Identity(), 0.01);
  near.add({0.1, 0.0, 0.2}, 0.3);
  EXPECT_EQ(near.pixels().bottom, 240);
}

TEST(Visibility, ABoxAndThePartsAroundItCoverTheImageOnce) {
  const PixelBox whole{0, 0, 30, 20};
  for (const PixelBox& box : {PixelBox{4, 8, 12, 16}, PixelBox{0, 0, 30, 20}, PixelBox{8, 0, 30, 4}, PixelBox{}}) {
    std::vector<int> covered(30 * 20);
    std::vector<PixelBox> parts{box};
    for (const PixelBox& part : around(box, whole)) parts.push_back(part);
    for (const PixelBox& part : parts) {
      for (int v = part.top; v < part.bottom; ++v)
        for (int u = part.left; u < part.right; ++u) ++covered.at(static_cast<std::size_t>(30 * v + u));
    }
    EXPECT_EQ(covered, std::vector<int>(30 * 20, 1));
  }
}

}  // namespace
}  // namespace constrictor
