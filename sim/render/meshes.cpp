#include "sim/render/meshes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace constrictor {

using Eigen::Vector2d;
using Eigen::Vector3d;
using std::numbers::pi;

std::uint32_t Mesh::add(const Vector3d& p, const Vector3d& n, double shade) {
  for (const double value : {p.x(), p.y(), p.z(), n.x(), n.y(), n.z(), shade})
    vertices.push_back(static_cast<float>(value));
  return static_cast<std::uint32_t>(vertices.size() / kFloatsPerVertex - 1);
}

void Mesh::triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) { indices.insert(indices.end(), {a, b, c}); }

namespace {

/// A ring of a body of revolution about x. Position and normal are in the plane of x and radius.
struct Ring {
  double x, radius, normal_x, normal_radius, shade;
};

Mesh revolve(const std::vector<Ring>& rings, int segments) {
  Mesh mesh;
  for (const Ring& ring : rings) {
    for (int s = 0; s <= segments; ++s) {
      const double angle = 2.0 * pi * s / segments;
      const double c = std::cos(angle);
      const double d = std::sin(angle);
      mesh.add({ring.x, ring.radius * c, ring.radius * d},
               {ring.normal_x, ring.normal_radius * c, ring.normal_radius * d}, ring.shade);
    }
  }
  const auto columns = static_cast<std::uint32_t>(segments + 1);
  for (std::uint32_t row = 0; row + 1 < rings.size(); ++row) {
    for (std::uint32_t s = 0; s + 1 < columns; ++s) {
      const std::uint32_t a = row * columns + s;        // nearer the front
      const std::uint32_t b = (row + 1) * columns + s;  // nearer the back
      mesh.triangle(a, b + 1, a + 1);
      mesh.triangle(a, b, b + 1);
    }
  }
  return mesh;
}

/// The front half of a module (x > 0), from its tip to the end of the shell.
std::vector<Ring> front_half(double length_m, double radius_m, int rings, bool head) {
  constexpr double kJointShade = 0.4;
  constexpr double kJointRadius = 0.84;  // relative to the radius of the module
  constexpr double kShellEnd = 0.78;     // relative to half the length of the module
  constexpr double kBevelEnd = 0.90;
  const double ball_radius = head ? radius_m : kJointRadius * radius_m;
  const double shade = head ? 1.0 : kJointShade;
  std::vector<Ring> half;
  for (int i = 0; i <= rings; ++i) {
    const double angle = pi / 2.0 * (1.0 - static_cast<double>(i) / rings);
    half.push_back({length_m / 2 + ball_radius * std::sin(angle), ball_radius * std::cos(angle), std::sin(angle),
                    std::cos(angle), shade});
  }
  if (!head) {
    const double bevel_x = kBevelEnd * length_m / 2;
    const double shell_x = kShellEnd * length_m / 2;
    const Vector2d slope = Vector2d(radius_m - ball_radius, bevel_x - shell_x).normalized();
    half.push_back({bevel_x, ball_radius, 0.0, 1.0, kJointShade});
    half.push_back({bevel_x, ball_radius, slope.x(), slope.y(), 1.0});
    half.push_back({shell_x, radius_m, slope.x(), slope.y(), 1.0});
    half.push_back({shell_x, radius_m, 0.0, 1.0, 1.0});
  }
  return half;
}

Mesh make_body(double length_m, double radius_m, int segments, int rings, bool head) {
  std::vector<Ring> all = front_half(length_m, radius_m, rings, head);
  std::vector<Ring> back = front_half(length_m, radius_m, rings, false);
  std::reverse(back.begin(), back.end());
  for (const Ring& ring : back) all.push_back({-ring.x, ring.radius, -ring.normal_x, ring.normal_radius, ring.shade});
  return revolve(all, segments);
}

}  // namespace

Mesh make_module(double length_m, double radius_m, int segments, int rings) {
  return make_body(length_m, radius_m, segments, rings, false);
}

Mesh make_head(double length_m, double radius_m, int segments, int rings) {
  return make_body(length_m, radius_m, segments, rings, true);
}

Mesh make_cylinder(int segments) {
  Mesh mesh;
  const std::uint32_t top = mesh.add({0, 0, 0.5}, {0, 0, 1});
  const std::uint32_t bottom = mesh.add({0, 0, -0.5}, {0, 0, -1});
  std::uint32_t previous[4] = {};
  for (int s = 0; s <= segments; ++s) {
    const double angle = 2.0 * pi * s / segments;
    const double c = std::cos(angle);
    const double d = std::sin(angle);
    const std::uint32_t ring[4] = {mesh.add({c, d, 0.5}, {0, 0, 1}), mesh.add({c, d, 0.5}, {c, d, 0}),
                                   mesh.add({c, d, -0.5}, {c, d, 0}), mesh.add({c, d, -0.5}, {0, 0, -1})};
    if (s > 0) {
      mesh.triangle(top, previous[0], ring[0]);
      mesh.triangle(previous[1], previous[2], ring[2]);
      mesh.triangle(previous[1], ring[2], ring[1]);
      mesh.triangle(bottom, ring[3], previous[3]);
    }
    std::copy_n(ring, 4, previous);
  }
  return mesh;
}

Mesh make_box() {
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {1.0, -1.0}) {
      Vector3d n = Vector3d::Zero();
      n[axis] = side;
      Vector3d a = Vector3d::Zero();
      a[(axis + 1) % 3] = 0.5;
      Vector3d b = Vector3d::Zero();
      b[(axis + 2) % 3] = 0.5 * side;  // keeps a x b along n
      const std::uint32_t v0 = mesh.add(n / 2 - a - b, n);
      mesh.add(n / 2 + a - b, n);
      mesh.add(n / 2 + a + b, n);
      mesh.add(n / 2 - a + b, n);
      mesh.triangle(v0, v0 + 1, v0 + 2);
      mesh.triangle(v0, v0 + 2, v0 + 3);
    }
  }
  return mesh;
}

Mesh make_ribbon(const std::vector<Vector2d>& line_m, double width_m) {
  Mesh mesh;
  std::vector<Vector2d> points;
  for (const Vector2d& p : line_m) {
    if (points.empty() || (p - points.back()).norm() > 1e-6) points.push_back(p);
  }
  if (points.size() < 2) return mesh;
  const auto left_of = [](const Vector2d& d) { return Vector2d(-d.y(), d.x()); };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d in = i > 0 ? (points[i] - points[i - 1]).normalized() : (points[1] - points[0]).normalized();
    const Vector2d out = i + 1 < points.size() ? (points[i + 1] - points[i]).normalized() : in;
    // The corner of a mitre lies on both offset lines. Its length is bounded, so that a hairpin has no spike.
    const Vector2d bisector = left_of(in) + left_of(out);
    const double length = bisector.norm();
    const Vector2d normal = length > 1e-6 ? Vector2d(bisector / length) : left_of(in);
    const double scale = 1.0 / std::max(0.5, normal.dot(left_of(in)));
    const Vector2d offset = normal * scale * width_m / 2;
    mesh.add({points[i].x() + offset.x(), points[i].y() + offset.y(), 0}, {0, 0, 1});
    mesh.add({points[i].x() - offset.x(), points[i].y() - offset.y(), 0}, {0, 0, 1});
  }
  for (std::uint32_t i = 0; i + 1 < points.size(); ++i) {
    const std::uint32_t left = 2 * i;
    mesh.triangle(left, left + 1, left + 3);
    mesh.triangle(left, left + 3, left + 2);
  }
  return mesh;
}

Mesh make_disc(const Vector2d& centre_m, double radius_m, int segments) {
  Mesh mesh;
  const std::uint32_t centre = mesh.add({centre_m.x(), centre_m.y(), 0}, {0, 0, 1});
  for (int s = 0; s <= segments; ++s) {
    const double angle = 2.0 * pi * s / segments;
    const std::uint32_t v =
        mesh.add({centre_m.x() + radius_m * std::cos(angle), centre_m.y() + radius_m * std::sin(angle), 0}, {0, 0, 1});
    if (s > 0) mesh.triangle(centre, v - 1, v);
  }
  return mesh;
}

Mesh make_square(double half_extent_m) {
  Mesh mesh;
  for (const auto& [x, y] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}}) {
    mesh.add({x * half_extent_m, y * half_extent_m, 0}, {0, 0, 1});
  }
  mesh.triangle(0, 1, 2);
  mesh.triangle(0, 2, 3);
  return mesh;
}

}  // namespace constrictor
