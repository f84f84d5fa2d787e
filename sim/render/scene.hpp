// The values that the renderer draws, in the world frame W (z up, ground at z = 0). They contain neither messages nor
// OpenGL.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/scenario_loader/reflectance.hpp"

namespace constrictor {

enum class SolidShape { kCylinder, kBox };

/// An object, wall or peg. The origin of its frame is its centre; z is the axis of a cylinder.
struct Solid {
  SolidShape shape = SolidShape::kCylinder;
  Eigen::Vector3d size_m{0.1, 0.1, 0.1};  ///< cylinder: radius, radius, height; box: extents
  Rgb colour;
};

/// A coloured disc on the ground.
struct Disc {
  Eigen::Vector2d centre_m{0.0, 0.0};
  double radius_m = 0.0;
  Rgb colour;
};

struct Light {
  Eigen::Vector3d direction{0.3, -0.4, 0.85};  ///< unit vector in W, from the scene to the light
  double intensity = 1.0;                      ///< of the directional light; 1 is nominal
  double ambient = 0.35;                       ///< 0 to 1
};

/// The part of the scene that does not change during an epoch.
struct Scene {
  double module_length_m = 0.089;  ///< [m] from joint to joint
  double module_radius_m = 0.035;
  std::vector<Solid> objects;    ///< their poses are ScenePoses::X_WObject
  std::vector<Solid> obstacles;  ///< walls and pegs
  std::vector<Eigen::Isometry3d> X_WObstacle;
  std::vector<Disc> zones;
  std::vector<Eigen::Vector2d> line_m;  ///< centre line of the ribbon
  double line_width_m = 0.05;
  Rgb line_colour;
  Rgb ground_colour{0.5F, 0.5F, 0.5F};
  double ground_gloss = 0.0;  ///< strength of the light's reflection in ground, zones and line; 0: matt, 1: polished
  Light light;
};

/// The poses of the bodies that move.
struct ScenePoses {
  std::vector<Eigen::Isometry3d> X_WModule;  ///< head first; x forward, origin at the centre of the module
  std::vector<Eigen::Isometry3d> X_WObject;  ///< in the order of Scene::objects
};

/// Pin-hole camera: u = fx X/Z + cx, v = fy Y/Z + cy for a point (X, Y, Z) of the camera's frame C (z along the view, x
/// right, y down). Pixel centres lie at +0.5, the origin is the top left corner.
struct PinholeCamera {
  int width = 320;
  int height = 240;
  double fx = 160.0;  ///< [pixel]
  double fy = 160.0;
  double cx = 160.0;
  double cy = 120.0;
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
};

/// A camera with square pixels and the principal point in the middle.
[[nodiscard]] PinholeCamera make_pinhole(int width, int height, double horizontal_fov_rad);

/// The pose of a camera at `eye` that looks at `target`, both in W, with the image upright.
[[nodiscard]] Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target);

}  // namespace constrictor
