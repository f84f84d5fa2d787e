// The mesh of a module, against the volume and the size of a capsule.
#include "robot/module_mesh.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <map>
#include <numbers>
#include <tuple>

#include "support/project.hpp"

namespace constrictor {
namespace {

using Corner = std::tuple<double, double, double>;

Corner rounded(const Eigen::Vector3d& p) {
  const auto round = [](double value) { return std::round(value * 1e9); };
  return {round(p.x()), round(p.y()), round(p.z())};
}

TEST(ModuleMesh, IsTheClosedSurfaceOfTheCapsule) {
  const RobotModel robot = load_robot(testing::robot_path("mamba"));
  const auto triangles = module_mesh(robot);
  std::map<std::pair<Corner, Corner>, int> edges;
  double volume_m3 = 0.0;
  Eigen::AlignedBox3d box;
  for (const auto& [a, b, c] : triangles) {
    volume_m3 += a.dot(b.cross(c)) / 6.0;  // positive if the corners are counter-clockwise seen from outside
    for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) ++edges[{rounded(p), rounded(q)}];
    for (const auto& p : {a, b, c}) box.extend(p);
  }
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first})) << "a hole";
  }
  const double r = robot.module_radius_m, length = robot.module_length_m;
  const double capsule_m3 = std::numbers::pi * r * r * (length + 4.0 / 3.0 * r);
  EXPECT_LT(volume_m3, capsule_m3) << "the corners lie on the capsule, the triangles inside";
  EXPECT_GT(volume_m3, 0.98 * capsule_m3);
  EXPECT_TRUE(box.sizes().isApprox(Eigen::Vector3d(length + 2 * r, 2 * r, 2 * r), 1e-9)) << box.sizes().transpose();
}

TEST(ModuleMesh, ItsFileIsBinaryStl) {
  const std::string file = stl_file({{Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(2, 0, 0), Eigen::Vector3d(0, 3, 0)}});
  ASSERT_EQ(file.size(), 80u + 4 + 50);
  EXPECT_FALSE(file.starts_with("solid")) << "that is how a text file begins";
  std::uint32_t count = 0;
  std::memcpy(&count, file.data() + 80, 4);
  EXPECT_EQ(count, 1u);
  float numbers[12];
  std::memcpy(numbers, file.data() + 84, sizeof numbers);
  EXPECT_EQ(std::vector<float>(numbers, numbers + 12), (std::vector<float>{0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 0}));
}

}  // namespace
}  // namespace constrictor
