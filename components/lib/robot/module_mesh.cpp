#include "robot/module_mesh.hpp"

#include <Eigen/Geometry>

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace constrictor {
namespace {

constexpr int kAround = 48, kOfCap = 12;

/// Little-endian, as STL demands.
void put(std::string& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFF);
}

void put(std::string& bytes, const Eigen::Vector3d& vector) {
  for (const double value : {vector.x(), vector.y(), vector.z()})
    put(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(value)), 4);
}

}  // namespace

std::vector<MeshTriangle> module_mesh(const RobotModel& robot) {
  const double r = robot.module_radius_m;
  // The rings from the front to the back: a cap, the cylinder between two rings, and the other cap.
  struct Ring {
    double x_m, radius_m;
  };
  std::vector<Ring> rings;
  for (const double end : {1.0, -1.0}) {
    for (int i = 0; i <= kOfCap; ++i) {
      const double angle = 0.5 * std::numbers::pi * (end > 0 ? kOfCap - i : i) / kOfCap;
      rings.push_back({end * (0.5 * robot.module_length_m + r * std::sin(angle)), r * std::cos(angle)});
    }
  }
  const auto corner = [&](const Ring& ring, int step) {
    const double angle = 2.0 * std::numbers::pi * (step % kAround) / kAround;
    return Eigen::Vector3d(ring.x_m, ring.radius_m * std::cos(angle), ring.radius_m * std::sin(angle));
  };
  std::vector<MeshTriangle> triangles;
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) {
    for (int step = 0; step < kAround; ++step) {
      const Eigen::Vector3d a = corner(rings[i], step), b = corner(rings[i], step + 1);
      const Eigen::Vector3d c = corner(rings[i + 1], step), d = corner(rings[i + 1], step + 1);
      if (i > 0) triangles.push_back({a, c, b});                 // the first ring is a point
      if (i + 2 < rings.size()) triangles.push_back({b, c, d});  // and the last one
    }
  }
  return triangles;
}

std::string stl_file(const std::vector<MeshTriangle>& triangles) {
  std::string bytes = std::string(kStlBegin) + "; unit: m";
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(triangles.size()), 4);
  for (const auto& [a, b, c] : triangles) {
    put(bytes, (b - a).cross(c - a).normalized());
    for (const auto& corner : {a, b, c}) put(bytes, corner);
    put(bytes, 0, 2);
  }
  return bytes;
}

}  // namespace constrictor
