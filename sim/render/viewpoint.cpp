#include "sim/render/viewpoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace constrictor {

using Eigen::Vector2d;
using Eigen::Vector3d;

PinholeCamera fit_view(const std::vector<Vector3d>& points_m, double heading_rad, double elevation_rad,
                       double horizontal_fov_rad, int width, int height, double margin) {
  PinholeCamera camera = make_pinhole(width, height, horizontal_fov_rad);
  const Vector3d forward(std::cos(heading_rad) * std::cos(elevation_rad),
                         std::sin(heading_rad) * std::cos(elevation_rad), -std::sin(elevation_rad));
  camera.X_WC = look_at(Vector3d::Zero(), forward);
  if (points_m.empty()) return camera;
  // A point (x, y, z) seen from (a, b, -d) is in the picture if |x - a| <= s (z + d). Each border is reached by one
  // point first. In the direction that has less room, the nearest camera has a point on both opposite borders.
  const double slope_x = (0.5 - margin) * width / camera.fx;
  const double slope_y = (0.5 - margin) * height / camera.fy;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double right = -kInfinity, left = kInfinity, low = -kInfinity, high = kInfinity;
  for (const Vector3d& p : points_m) {
    const Vector3d c = camera.X_WC.linear().transpose() * p;
    right = std::max(right, c.x() - slope_x * c.z());
    left = std::min(left, c.x() + slope_x * c.z());
    low = std::max(low, c.y() - slope_y * c.z());
    high = std::min(high, c.y() + slope_y * c.z());
  }
  const double distance = std::max((right - left) / (2.0 * slope_x), (low - high) / (2.0 * slope_y));
  // In the other direction the free room is the same on both sides.
  const auto centred = [&](int axis, double from, double to) {
    for (int i = 0; i < 50; ++i) {
      const double middle = (from + to) / 2.0;
      double most = -kInfinity, least = kInfinity;
      for (const Vector3d& p : points_m) {
        const Vector3d c = camera.X_WC.linear().transpose() * p;
        most = std::max(most, (c[axis] - middle) / (c.z() + distance));
        least = std::min(least, (c[axis] - middle) / (c.z() + distance));
      }
      (most + least > 0.0 ? from : to) = middle;
    }
    return (from + to) / 2.0;
  };
  const double reach = 2.0 * distance + std::abs(right) + std::abs(left) + std::abs(low) + std::abs(high);
  const Vector3d eye(centred(0, -reach, reach), centred(1, -reach, reach), -distance);
  camera.X_WC.translation() = camera.X_WC.linear() * eye;
  return camera;
}

std::vector<Vector3d> scene_extent(const Scene& scene, const Surroundings& surroundings) {
  std::vector<Vector3d> points;
  const auto add_circle = [&points](const Vector2d& centre, double radius) {
    for (int i = 0; i < 8; ++i) {
      const double angle = std::numbers::pi / 4.0 * i;
      points.emplace_back(centre.x() + radius * std::cos(angle), centre.y() + radius * std::sin(angle), 0.0);
    }
  };
  const auto add_pair = [&](const Vector2d& end, const Vector2d& outwards, double distance_m) {
    const Vector2d direction = outwards.norm() > 0.0 ? Vector2d(outwards.normalized()) : Vector2d::UnitX();
    const Vector2d side(-direction.y(), direction.x());
    for (const double sign : {1.0, -1.0}) {
      const Vector2d p = end + distance_m * direction + sign * surroundings.half_width_m * side;
      points.emplace_back(p.x(), p.y(), 0.0);
    }
  };
  for (const Vector2d& p : scene.line_m) points.emplace_back(p.x(), p.y(), 0.0);
  for (const Disc& zone : scene.zones) add_circle(zone.centre_m, zone.radius_m);
  if (const std::size_t n = scene.line_m.size(); n >= 2) {
    add_pair(scene.line_m[0], scene.line_m[0] - scene.line_m[1], surroundings.behind_m);
    add_pair(scene.line_m[n - 1], scene.line_m[n - 1] - scene.line_m[n - 2], surroundings.ahead_m);
  }
  if (points.empty()) add_circle(Vector2d::Zero(), 2.0);
  return points;
}

std::vector<Vector3d> bodies_extent(const ScenePoses& poses) {
  constexpr double kStep_m = 0.5;
  Eigen::AlignedBox2d box;
  for (const auto* bodies : {&poses.X_WModule, &poses.X_WObject}) {
    for (const Eigen::Isometry3d& X_WBody : *bodies) box.extend(Vector2d(X_WBody.translation().head<2>()));
  }
  if (box.isEmpty()) return {};
  const Vector2d low = kStep_m * (box.min() / kStep_m).array().floor();
  const Vector2d high = kStep_m * (box.max() / kStep_m).array().ceil();
  return {{low.x(), low.y(), 0.0}, {high.x(), low.y(), 0.0}, {high.x(), high.y(), 0.0}, {low.x(), high.y(), 0.0}};
}

double side_heading(const Scene& scene) {
  if (scene.line_m.size() < 2) return std::numbers::pi / 2.0;
  const Vector2d along = scene.line_m.back() - scene.line_m.front();
  return std::atan2(along.y(), along.x()) + std::numbers::pi / 2.0;
}

ShadowRegion shadow_region_of(const std::vector<Vector3d>& points_m) {
  ShadowRegion region;
  if (points_m.empty()) return region;
  Eigen::AlignedBox2d box;
  for (const Vector3d& p : points_m) box.extend(Vector2d(p.head<2>()));
  region.centre_m = (box.min() + box.max()) / 2.0;
  region.radius_m = box.diagonal().norm() / 2.0 + 0.3;
  return region;
}

}  // namespace constrictor
