// Triangle meshes of unit shapes, of the line's ribbon and of discs.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace constrictor {

/// Positions and normals interleaved (x y z nx ny nz shade), triangles counter-clockwise seen from outside. `shade` scales the
/// colour, so that one mesh can have darker parts.
struct Mesh {
  static constexpr int kFloatsPerVertex = 7;
  std::vector<float> vertices;
  std::vector<std::uint32_t> indices;

  std::uint32_t add(const Eigen::Vector3d& p, const Eigen::Vector3d& n, double shade = 1.0);
  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
};

/// A snake module along x around the origin: a shell of radius `radius_m` between two dark balls at the joints, `length_m`
/// apart. The balls are a little thinner than the capsule that the physics knows, so that the joints can be seen.
Mesh make_module(double length_m, double radius_m, int segments, int rings);
/// The first module: its front (+x) is the full half sphere.
Mesh make_head(double length_m, double radius_m, int segments, int rings);
/// Radius 1, height 1, axis z, centred.
Mesh make_cylinder(int segments);
/// Extents 1, centred.
Mesh make_box();
/// Flat ribbon around a polyline on z = 0, mitred at its corners.
Mesh make_ribbon(const std::vector<Eigen::Vector2d>& line_m, double width_m);
/// Flat disc on z = 0.
Mesh make_disc(const Eigen::Vector2d& centre_m, double radius_m, int segments);
/// Square on z = 0 around the origin.
Mesh make_square(double half_extent_m);

}  // namespace constrictor
