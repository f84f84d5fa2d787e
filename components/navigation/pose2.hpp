// A pose in the plane, with the axes of its frame.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace constrictor {

/// Position [m] and heading [rad, positive left] of a frame in its parent frame.
struct Pose2 {
  Eigen::Vector2d p{0.0, 0.0};
  double yaw_rad = 0.0;

  [[nodiscard]] Eigen::Vector2d forward() const { return {std::cos(yaw_rad), std::sin(yaw_rad)}; }
  [[nodiscard]] Eigen::Vector2d left() const { return {-std::sin(yaw_rad), std::cos(yaw_rad)}; }
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
