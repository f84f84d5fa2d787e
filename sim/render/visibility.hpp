// Tests whether a camera can see a body. The renderer leaves out bodies that cannot change a single pixel of the image.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "sim/render/scene.hpp"

namespace constrictor {

/// The part of space that a camera sees. The tests are one-sided: true may be wrong, false is always right. They leave
/// a margin that is far greater than the rounding errors of the single precision in which OpenGL projects points.
class ViewVolume {
 public:
  /// `near_m` [m]: distance along the view at which the visible space begins.
  ViewVolume(const PinholeCamera& camera, double near_m);

  /// Whether a part of a sphere may be visible. `centre` in W.
  [[nodiscard]] bool may_contain(const Eigen::Vector3d& centre, double radius_m) const {
    return may_contain(centre, centre, radius_m);
  }
  /// Whether a part of a sphere may be visible while it moves straight from `from` to `to`, both in W.
  [[nodiscard]] bool may_contain(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m) const;

 private:
  // Each row is a unit normal n that points inwards, and an offset d: n·p + d is the distance [m] of p from the plane.
  std::array<Eigen::Vector4d, 5> planes_;
};

/// The square that a shadow map covers, seen from the light, and the light itself.
class ShadowVolume {
 public:
  /// `slack_m` [m]: how far from its own place a surface may look into the shadow map.
  ShadowVolume(const Eigen::Matrix4f& shadow_from_world, const Eigen::Vector3d& to_light, double slack_m);

  /// Whether a body inside of a sphere may throw a shadow that `view` sees. One-sided, as for ViewVolume. Surfaces that
  /// receive shadows lie above z = -0.1 m.
  [[nodiscard]] bool may_shade(const ViewVolume& view, const Eigen::Vector3d& centre, double radius_m) const;

 private:
  Eigen::Matrix4d shadow_from_world_;
  Eigen::Vector3d to_light_;
  double slack_m_;
};

/// A rectangle of whole pixels. Row 0 is the top row; the column `right` and the row `bottom` are not part of it.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  [[nodiscard]] bool empty() const { return left >= right || top >= bottom; }
};

[[nodiscard]] inline PixelBox whole_image(const PinholeCamera& camera) { return {0, 0, camera.width, camera.height}; }

/// The parts of `whole` above, below, left and right of `box`, which lies in it. Parts may be empty.
[[nodiscard]] std::array<PixelBox, 4> around(const PixelBox& box, const PixelBox& whole);

/// The part of an image in which bodies may throw shadows on the ground (z = 0).
class ShadowedGround {
 public:
  /// `near_m` and `slack_m` as for ViewVolume and ShadowVolume.
  ShadowedGround(const PinholeCamera& camera, double near_m, const Eigen::Matrix4f& shadow_from_world, double slack_m);
  /// Adds the shadow of a body inside of a sphere. `centre` in W.
  void add(const Eigen::Vector3d& centre, double radius_m);
  /// Contains all pixels at which the ground looks up a place of the shadow map at which an added body may be drawn.
  [[nodiscard]] PixelBox pixels() const;

 private:
  PinholeCamera camera_;
  Eigen::Isometry3d X_CW_;
  double near_m_;
  Eigen::Matrix4d shadow_from_world_;
  double slack_m_;
  Eigen::AlignedBox2d bounds_;  // [pixel] of everything that was added
};

}  // namespace constrictor
