// The body on the ground: places, headings and velocities of its modules relative to the head.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "robot/robot_model.hpp"

namespace constrictor::guidance {

/// What the body's shape is and how it changes, in the head's frame (x forward, y left), as if the head stood still.
/// The body is taken as planar: pitch joints are straight while it moves on flat ground.
struct BodyChain {
  struct Link {
    Eigen::Vector2d p_m{0.0, 0.0};    ///< module's centre
    double heading_rad = 0.0;         ///< of the module's x axis
    Eigen::Vector2d v_m_s{0.0, 0.0};  ///< from the joint rates alone
    double rate_rad_s = 0.0;
  };
  std::vector<Link> links;  ///< head to tail
};

/// `position_rad`, `velocity_rad_s`: model.module_count - 1 joints, head to tail. Yaw joint i turns the head-side module i by
/// its angle relative to module i + 1.
BodyChain body_chain(const RobotModel& model, const double* position_rad, const double* velocity_rad_s);

/// Unit vectors along and to the left of a heading.
Eigen::Vector2d along(double heading_rad);
Eigen::Vector2d left(double heading_rad);
/// `p` turned by an angle.
Eigen::Vector2d turned(const Eigen::Vector2d& p, double angle_rad);
/// Angle in (-pi, pi].
double wrapped(double angle_rad);

}  // namespace constrictor::guidance
