// A scene with everything that a renderer can draw, and a camera that sees it.
#pragma once

#include <cmath>

#include "sim/render/renderer.hpp"

namespace constrictor::testing {

inline Scene busy_scene() {
  Scene scene;
  for (int i = 0; i <= 40; ++i) scene.line_m.emplace_back(0.1 * i, 0.4 * std::sin(0.2 * i));
  scene.line_colour = colour_reflectance(3);
  scene.zones = {{{0.5, 0.8}, 0.3, colour_reflectance(1)}};
  scene.objects = {{SolidShape::kCylinder, {0.08, 0.08, 0.15}, colour_reflectance(2)},
                   {SolidShape::kBox, {0.1, 0.2, 0.15}, colour_reflectance(1)}};
  scene.obstacles = {{SolidShape::kBox, {0.1, 1.0, 0.3}, colour_reflectance(0)}};
  scene.X_WObstacle = {Eigen::Isometry3d(Eigen::Translation3d(4.0, 1.0, 0.15))};
  scene.light.direction = Eigen::Vector3d(0.4, -0.5, 0.7).normalized();
  return scene;
}

/// Of a snake of 24 modules and the two objects.
inline ScenePoses busy_poses() {
  ScenePoses poses;
  for (int i = 0; i < 24; ++i) {
    poses.X_WModule.push_back(Eigen::Translation3d(2.0 - 0.089 * i, 0.1 * std::sin(0.5 * i), 0.035) *
                              Eigen::AngleAxisd(0.3 * std::cos(0.5 * i), Eigen::Vector3d::UnitZ()));
  }
  poses.X_WObject = {Eigen::Isometry3d(Eigen::Translation3d(2.8, 0.3, 0.075)),
                     Eigen::Isometry3d(Eigen::Translation3d(3.0, -0.4, 0.075))};
  return poses;
}

inline PinholeCamera scene_camera(int width = 160, int height = 120) {
  PinholeCamera camera = make_pinhole(width, height, 1.2);
  camera.X_WC = look_at({0.5, -2.0, 1.5}, {2.0, 0.0, 0.0});
  return camera;
}

}  // namespace constrictor::testing
