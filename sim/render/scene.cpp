#include "sim/render/scene.hpp"

#include <cmath>
#include <iterator>

#include "constrictor/messages.hpp"

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

Rgb colour_reflectance(std::uint8_t colour) {
  // One row for each constant kColour… of the IDL, in their order.
  static constexpr Rgb kReflectance[] = {
      {0.35F, 0.35F, 0.35F},  // unknown
      {0.04F, 0.50F, 0.09F},  // green
      {0.62F, 0.03F, 0.03F},  // red
      {0.03F, 0.13F, 0.62F},  // blue
      {0.80F, 0.58F, 0.03F},  // yellow
  };
  static_assert(std::size(kReflectance) == msg::kColourCount, "each colour of the IDL needs a row in kReflectance");
  return kReflectance[colour < msg::kColourCount ? colour : msg::kColourUnknown];
}

}  // namespace constrictor
