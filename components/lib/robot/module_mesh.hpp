// The shape of a module as a mesh, for programs that draw the robot.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor {

/// The corners [m] of a triangle, counter-clockwise when seen from outside.
using MeshTriangle = std::array<Eigen::Vector3d, 3>;

/// The closed surface of a module about its centre, x along its axis: the capsule of the simulator. A mesh of one's
/// own, with the same frame, can take its place.
[[nodiscard]] std::vector<MeshTriangle> module_mesh(const RobotModel& robot);

/// The text with which stl_file() begins.
inline constexpr std::string_view kStlBegin = "a module, written by `constrictor robot export`";
/// The bytes of a binary STL file. Source: en.wikipedia.org/wiki/STL_(file_format), section "Binary".
[[nodiscard]] std::string stl_file(const std::vector<MeshTriangle>& triangles);

}  // namespace constrictor
