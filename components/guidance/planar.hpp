// Small helpers of plane geometry.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace constrictor::guidance {

/// Unit vectors along and to the left of a heading.
inline Eigen::Vector2d along(double heading_rad) { return {std::cos(heading_rad), std::sin(heading_rad)}; }
inline Eigen::Vector2d left(double heading_rad) { return {-std::sin(heading_rad), std::cos(heading_rad)}; }

/// `p` turned by an angle.
inline Eigen::Vector2d turned(const Eigen::Vector2d& p, double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {c * p.x() - s * p.y(), s * p.x() + c * p.y()};
}

/// Angle in (-pi, pi].
inline double wrapped(double angle_rad) {
  const double turn = 2.0 * std::numbers::pi;
  const double rest = std::fmod(angle_rad + std::numbers::pi, turn);
  return (rest <= 0.0 ? rest + turn : rest) - std::numbers::pi;
}

}  // namespace constrictor::guidance
