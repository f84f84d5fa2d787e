// Rotations in space.
#pragma once

#include <Eigen/Geometry>

#include "constrictor/messages.hpp"

namespace constrictor {

/// Rotation matrix of a unit quaternion (normalised here; identity if it is zero or not finite).
[[nodiscard]] Eigen::Matrix3d rotation_from(const msg::Quaternion& orientation);

/// The rotation by the smallest angle that turns the direction `from` into the direction `to`. Their lengths do not
/// matter. This is Eigen's FromTwoVectors(), in a file of its own because it takes the compiler 6 s.
[[nodiscard]] Eigen::Quaterniond shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace constrictor
