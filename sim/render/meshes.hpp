// Triangle meshes of the robot's modules, unit solids, the line and zones.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace constrictor {

/// Vertices are x y z nx ny nz shade; `shade` scales the colour, so that one mesh can have darker parts. Triangles are
/// counter-clockwise as seen from outside.
struct Mesh {
  static constexpr int kFloatsPerVertex = 7;
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;

  std::uint32_t add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double shade = 1.0);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
};

/// A module along x around the origin: a shell of radius `radius_m` between two dark balls at the joints, which are
/// `length_m` apart. The balls are thinner than the capsule of the physics, so that the joints are visible.
Mesh make_module(double length_m, double radius_m, int segments, int rings);
/// The first module: its front (+x) is the full half sphere.
Mesh make_head(double length_m, double radius_m, int segments, int rings);
/// A cylinder of radius 1 and height 1 about z; the origin is its centre.
Mesh make_cylinder(int segments);
/// A cube of edge 1; the origin is its centre.
Mesh make_box();
/// A flat ribbon along a polyline on z = 0, mitred at its corners.
Mesh make_ribbon(const std::vector<Eigen::Vector2d>& line_m, double width_m);
/// A flat disc on z = 0.
Mesh make_disc(const Eigen::Vector2d& centre_m, double radius_m, int segments);
/// A square on z = 0 around the origin.
Mesh make_square(double half_extent_m);

}  // namespace constrictor
