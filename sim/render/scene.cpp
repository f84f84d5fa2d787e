#include "sim/render/scene.hpp"

#include <cmath>

namespace constrictor {

PinholeCamera make_pinhole(int width, int height, double horizontal_fov_rad) {
  PinholeCamera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = width / (2.0 * std::tan(horizontal_fov_rad / 2.0));
  camera.fy = camera.fx;
  camera.cx = width / 2.0;
  camera.cy = height / 2.0;
  return camera;
}

Eigen::Isometry3d look_at(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  const Eigen::Vector3d z = (target - eye).normalized();
  Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ());
  if (x.norm() < 1e-9) x = -Eigen::Vector3d::UnitY();  // looking straight down, the top of the image is +x of W
  x.normalize();
  Eigen::Isometry3d X_WC = Eigen::Isometry3d::Identity();
  X_WC.linear().col(0) = x;
  X_WC.linear().col(1) = z.cross(x);
  X_WC.linear().col(2) = z;
  X_WC.translation() = eye;
  return X_WC;
}

}  // namespace constrictor
