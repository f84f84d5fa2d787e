// The scene of the camera's benchmarks: the view of the head along a line with two objects and a zone; the body
// undulates behind it.
#pragma once

#include <cmath>

#include "component/data_path.hpp"
#include "robot/camera_mount.hpp"
#include "robot/robot_model.hpp"
#include "sim/camera/camera.hpp"
#include "sim/render/renderer.hpp"

namespace constrictor::bench {

struct CameraScene {
  Scene scene;
  ScenePoses poses;
  PinholeCamera camera;
  ShadowRegion region;

  explicit CameraScene(double tilt_rad = 0.3) {
    for (int i = 0; i <= 200; ++i) scene.line_m.emplace_back(0.03 * i - 3.0, 0.2 * std::sin(0.05 * i));
    scene.line_colour = colour_reflectance(msg::kColourBlue);
    scene.zones = {{{1.2, 0.7}, 0.4, colour_reflectance(msg::kColourGreen)}};
    scene.objects = {{SolidShape::kCylinder, {0.08, 0.08, 0.15}, colour_reflectance(msg::kColourGreen)},
                     {SolidShape::kBox, {0.12, 0.12, 0.15}, colour_reflectance(msg::kColourRed)}};
    scene.light.direction = Eigen::Vector3d(0.3, -0.4, 0.85).normalized();
    poses.X_WObject = {Eigen::Isometry3d(Eigen::Translation3d(1.5, 0.3, 0.075)),
                       Eigen::Isometry3d(Eigen::Translation3d(1.3, -0.4, 0.075))};
    for (int i = 0; i < 24; ++i) {
      Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
      X.translate(Eigen::Vector3d(-0.085 * i, 0.1 * std::sin(0.5 * i), 0.035));
      X.rotate(Eigen::AngleAxisd(0.4 * std::cos(0.5 * i), Eigen::Vector3d::UnitZ()));
      poses.X_WModule.push_back(X);
    }
    CameraModel model = load_robot(data_path("components/lib/robot/mamba.yaml")).camera;
    model.tilt_rad = tilt_rad;
    camera = camera_intrinsics(model);
    camera.X_WC = poses.X_WModule[0] * camera_mount(model);
    const double radius_m = CameraConfig{}.shadow_radius_m;
    region = {(camera.X_WC.translation() + 0.6 * radius_m * camera.X_WC.linear().col(2)).head<2>(), radius_m};
  }
};

}  // namespace constrictor::bench
