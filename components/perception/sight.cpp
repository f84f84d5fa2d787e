#include "perception/sight.hpp"

#include <cmath>

namespace constrictor::perception {

double azimuth_rad(const GroundCamera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d direction = camera.ray(pixel.x(), pixel.y());
  return std::atan2(direction.y(), direction.x());
}

double descent(const GroundCamera& camera, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d direction = camera.ray(pixel.x(), pixel.y());
  return -direction.z() / direction.head<2>().norm();
}

std::optional<VerticalPlane> vertical_plane(const GroundCamera& camera, double azimuth_rad) {
  const Eigen::Vector3d along(std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0);
  const auto far = camera.pixel(Eigen::Vector3d(camera.position() + 100.0 * along));
  const auto low = camera.pixel(Eigen::Vector3d(camera.position() + along - Eigen::Vector3d(0.0, 0.0, 0.3)));
  if (!far || !low || (*low - *far).norm() < 1.0) return std::nullopt;
  return VerticalPlane{*far, (*low - *far).normalized()};
}

double path_share(std::size_t i, std::size_t count, double width) {
  return 0.5 + width * (static_cast<double>(i) / static_cast<double>(count - 1) - 0.5);
}

}  // namespace constrictor::perception
