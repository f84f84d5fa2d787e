// Contact points between bodies, as plain geometry. ODE's own colliders are not used for the robot: for the few pairs
// of this world its spaces cost more than they save, and its collider of capsule and cylinder is an iterative search.
// The distance between a convex solid and a point that moves along the axis of a capsule is a convex function, so
// bisection finds its minimum exactly, with the same result every time.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "sim/scenario_loader/scenario.hpp"

namespace constrictor {

/// A contact point in W.
struct TouchPoint {
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};
  Eigen::Vector3d normal{0.0, 0.0, 1.0};  ///< unit vector from the second body into the first
  double depth_m = 0.0;                   ///< positive where the bodies overlap
};

/// At most 16 contact points, so that no step allocates memory. Further points are dropped.
class TouchPoints {
 public:
  void add(const TouchPoint& touch) {
    if (count_ < touches_.size()) touches_[count_++] = touch;
  }
  void clear() { count_ = 0; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] const TouchPoint& operator[](std::size_t i) const { return touches_[i]; }
  [[nodiscard]] const TouchPoint* begin() const { return touches_.data(); }
  [[nodiscard]] const TouchPoint* end() const { return touches_.data() + count_; }

 private:
  std::array<TouchPoint, 16> touches_;
  std::size_t count_ = 0;
};

/// A capsule: all points within `radius_m` of the segment from `front` to `back`.
struct Capsule {
  Eigen::Vector3d front;
  Eigen::Vector3d back;
  double radius_m = 0.0;
};

/// A cylinder (its axis is z) or a box. Its frame S has its origin at the centre.
struct ConvexSolid {
  BodyShape shape = BodyShape::kCylinder;
  Eigen::Vector3d size_m{0.1, 0.1, 0.1};  ///< as ScenarioObject::size_m
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
};

/// Adds the contact points of a capsule with a solid: at each end of the capsule, and between the ends if it is deeper
/// there.
void touch_capsule_solid(const Capsule& capsule, const ConvexSolid& solid, TouchPoints& touches);

/// Adds the point at which two capsules are closest, if they overlap. The normal points into `first`.
void touch_capsules(const Capsule& first, const Capsule& second, TouchPoints& touches);

/// Adds the contact points of a solid with the ground z = 0: the corners of a box, or four points on each rim of a
/// cylinder.
void touch_solid_ground(const ConvexSolid& solid, TouchPoints& touches);

}  // namespace constrictor
