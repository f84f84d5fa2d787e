// Poses and angles in the plane.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace constrictor {

/// [rad] the same angle within [-pi, pi]; computed without rounding error.
inline double wrap_angle(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

/// [rad] the same angle within (-pi, pi], rounded like `angle_rad + pi`. Guidance uses it: the last bits of its
/// estimates, and with them the hashes of recorded runs, depend on this rounding. Use wrap_angle in new code.
inline double wrap_angle_by_shift(double angle_rad) {
  const double turn = 2.0 * std::numbers::pi;
  const double rest = std::fmod(angle_rad + std::numbers::pi, turn);
  return (rest <= 0.0 ? rest + turn : rest) - std::numbers::pi;
}

/// Unit vector of a heading.
inline Eigen::Vector2d along(double heading_rad) { return {std::cos(heading_rad), std::sin(heading_rad)}; }

/// Unit vector to the left of a heading.
inline Eigen::Vector2d left(double heading_rad) { return {-std::sin(heading_rad), std::cos(heading_rad)}; }

/// A vector rotated by an angle, counter-clockwise.
inline Eigen::Vector2d turned(const Eigen::Vector2d& p, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
}

/// Position [m] and heading [rad, positive left] of a frame in its parent frame.
struct PlanarPose {
  Eigen::Vector2d p{0.0, 0.0};
  double yaw_rad = 0.0;

  [[nodiscard]] Eigen::Vector2d forward() const { return along(yaw_rad); }
  [[nodiscard]] Eigen::Vector2d left() const { return constrictor::left(yaw_rad); }
  /// A point of this frame in the parent frame.
  [[nodiscard]] Eigen::Vector2d to_parent(const Eigen::Vector2d& p_local) const {
    return p + p_local.x() * forward() + p_local.y() * left();
  }
  /// A point of the parent frame in this frame.
  [[nodiscard]] Eigen::Vector2d to_local(const Eigen::Vector2d& p_parent) const {
    const Eigen::Vector2d d = p_parent - p;
    return {d.dot(forward()), d.dot(left())};
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(p.x(), p.y(), yaw_rad);
  }
};

}  // namespace constrictor
