// Spatial vectors: a velocity or a wrench of a rigid body as one vector of six numbers, in W about a point of
// reference. Source: R. Featherstone, Rigid Body Dynamics Algorithms, chapter 2.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace constrictor {

/// Velocity: angular velocity, then the velocity of the body's point at the reference. Wrench: moment about the
/// reference, then force.
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

[[nodiscard]] inline Vector6d spatial(const Eigen::Vector3d& angular, const Eigen::Vector3d& linear) {
  Vector6d vector;
  vector << angular, linear;
  return vector;
}

/// The matrix that turns a vector u into v x u.
[[nodiscard]] inline Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

/// The wrench of a force at the point `p` (from the reference). Its dot product with a spatial velocity is the power;
/// so for a unit force it is the velocity of the body at that point in the direction of the force.
[[nodiscard]] inline Vector6d at_point(const Eigen::Vector3d& p, const Eigen::Vector3d& force) {
  return spatial(p.cross(force), force);
}

/// The velocity of the point `p` (from the reference).
[[nodiscard]] inline Eigen::Vector3d velocity_at(const Vector6d& velocity, const Eigen::Vector3d& p) {
  return velocity.tail<3>() + velocity.head<3>().cross(p);
}

/// The matrix that turns a spatial velocity into the spatial momentum of a body whose centre is at `c`.
[[nodiscard]] inline Matrix6d spatial_inertia(double mass_kg, const Eigen::Matrix3d& inertia_kg_m2,
                                              const Eigen::Vector3d& c) {
  const Eigen::Matrix3d mc = mass_kg * skew(c);
  Matrix6d inertia;
  inertia.topLeftCorner<3, 3>() =
      inertia_kg_m2 + mass_kg * (c.squaredNorm() * Eigen::Matrix3d::Identity() - c * c.transpose());
  inertia.topRightCorner<3, 3>() = mc;
  inertia.bottomLeftCorner<3, 3>() = mc.transpose();
  inertia.bottomRightCorner<3, 3>() = mass_kg * Eigen::Matrix3d::Identity();
  return inertia;
}

}  // namespace constrictor
