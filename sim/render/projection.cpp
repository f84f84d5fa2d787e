#include "sim/render/projection.hpp"

#include <cmath>

namespace constrictor {

Eigen::Matrix4f clip_from_world(const PinholeCamera& camera, double near_m, double far_m) {
  Eigen::Matrix4d clip_from_camera = Eigen::Matrix4d::Zero();
  clip_from_camera(0, 0) = 2.0 * camera.fx / camera.width;
  clip_from_camera(0, 2) = 2.0 * camera.cx / camera.width - 1.0;
  clip_from_camera(1, 1) = 2.0 * camera.fy / camera.height;
  clip_from_camera(1, 2) = 2.0 * camera.cy / camera.height - 1.0;
  clip_from_camera(2, 2) = (far_m + near_m) / (far_m - near_m);
  clip_from_camera(2, 3) = -2.0 * far_m * near_m / (far_m - near_m);
  clip_from_camera(3, 2) = 1.0;
  const Eigen::Matrix4d clip = clip_from_camera * camera.X_WC.inverse().matrix();
  return clip.cast<float>();
}

Eigen::Matrix4f shadow_from_world(const Eigen::Vector3d& to_light, const ShadowRegion& region, int map_size) {
  constexpr double kDepth_m = 10.0;                                           // half of the depth covered
  const Eigen::Isometry3d X_WL = look_at(to_light, Eigen::Vector3d::Zero());  // only its rotation is used
  const Eigen::Matrix3d R_LW = X_WL.linear().transpose();
  Eigen::Vector3d centre = R_LW * Eigen::Vector3d(region.centre_m.x(), region.centre_m.y(), 0.0);
  const double texel_m = 2.0 * region.radius_m / map_size;
  for (int i = 0; i < 2; ++i) centre[i] = std::floor(centre[i] / texel_m) * texel_m;
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  matrix.topLeftCorner<3, 3>() = R_LW;
  matrix.topRightCorner<3, 1>() = -centre;
  const Eigen::Vector4d scale(1.0 / region.radius_m, 1.0 / region.radius_m, 1.0 / kDepth_m, 1.0);
  matrix = scale.asDiagonal() * matrix;
  return matrix.cast<float>();
}

}  // namespace constrictor
