// Where bodies touch, as plain geometry. ODE's spaces and generic colliders cost more than the few pairs of this world need, and
// its capsule against cylinder goes through an iterative support-function search; a capsule's distance to a convex solid along
// its segment is convex, so bisection is exact and always the same.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "sim/scenario/scenario.hpp"

namespace constrictor {

/// A touched point in W.
struct TouchPoint {
  Eigen::Vector3d position_m{0.0, 0.0, 0.0};
  Eigen::Vector3d normal{0.0, 0.0, 1.0};  ///< unit vector from the second body into the first
  double depth_m = 0.0;                   ///< > 0: overlap
};

/// A bounded list of touches, so that no tick allocates.
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

/// A cylinder (z its axis) or box about its centre.
struct ConvexSolid {
  BodyShape shape = BodyShape::kCylinder;
  Eigen::Vector3d size_m{0.1, 0.1, 0.1};  ///< as ScenarioObject::size_m
  Eigen::Isometry3d X_WS = Eigen::Isometry3d::Identity();
};

/// The capsule's touches of a solid: at each end and, where it is deeper, between them.
void touch_capsule_solid(const Capsule& capsule, const ConvexSolid& solid, TouchPoints& touches);

/// Where two capsules are closest, if they overlap. The normal points into `first`.
void touch_capsules(const Capsule& first, const Capsule& second, TouchPoints& touches);

/// TouchPoints of a solid with the ground z = 0: a box's corners below it, a cylinder's rims at four points each.
void touch_solid_ground(const ConvexSolid& solid, TouchPoints& touches);

}  // namespace constrictor
