#include "sim/render/visibility.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {
namespace {

constexpr double kMargin_m = 0.005;
constexpr double kLowestReceiver_m = -0.1;
constexpr int kBlock = 4;                    // llvmpipe shades blocks of 4 x 4 pixels
constexpr double kLongestShadow_m = 1000.0;  // longer than the part of the ground that is drawn

}  // namespace

ViewVolume::ViewVolume(const PinholeCamera& camera, double near_m) {
  // The planes through the borders of the image in the camera's frame: a point is inside of the left border if
  // fx X + cx Z > 0, of the right border if fx X + (cx - width) Z < 0, and so on.
  const std::array<Eigen::Vector3d, 5> normals{
      Eigen::Vector3d(camera.fx, 0.0, camera.cx), Eigen::Vector3d(-camera.fx, 0.0, camera.width - camera.cx),
      Eigen::Vector3d(0.0, camera.fy, camera.cy), Eigen::Vector3d(0.0, -camera.fy, camera.height - camera.cy),
      Eigen::Vector3d::UnitZ()};
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Eigen::Vector3d n_W = camera.X_WC.linear() * normals[i].normalized();
    planes_[i].head<3>() = n_W;
    planes_[i][3] = -n_W.dot(camera.X_WC.translation());
  }
  planes_.back()[3] -= near_m;
}

bool ViewVolume::may_contain(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius_m) const {
  return std::all_of(planes_.begin(), planes_.end(), [&](const Eigen::Vector4d& plane) {
    const double distance_m = std::max(plane.head<3>().dot(from), plane.head<3>().dot(to)) + plane[3];
    return distance_m > -(radius_m + kMargin_m);
  });
}

ShadowVolume::ShadowVolume(const Eigen::Matrix4f& shadow_from_world, const Eigen::Vector3d& to_light, double slack_m)
    : shadow_from_world_(shadow_from_world.cast<double>()), to_light_(to_light.normalized()), slack_m_(slack_m) {}

bool ShadowVolume::may_shade(const ViewVolume& view, const Eigen::Vector3d& centre, double radius_m) const {
  // Bodies beside the map are clipped. Bodies before or behind it are not: their depth is clamped.
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector4d row = shadow_from_world_.row(i);
    const double reach = 1.0 + (radius_m + kMargin_m) * row.head<3>().norm();
    if (std::abs(row.head<3>().dot(centre) + row[3]) > reach) return false;
  }
  // The shadow fills the space through which the sphere sweeps when it moves away from the light.
  const double drop_m = centre.z() + radius_m + slack_m_ - kLowestReceiver_m;
  const double rise = to_light_.z();
  const double length_m = rise * kLongestShadow_m > drop_m ? std::max(drop_m, 0.0) / rise : kLongestShadow_m;
  return view.may_contain(centre, centre - length_m * to_light_, radius_m + slack_m_);
}

std::array<PixelBox, 4> around(const PixelBox& box, const PixelBox& whole) {
  if (box.empty()) return {whole};
  return {PixelBox{whole.left, whole.top, whole.right, box.top},
          {whole.left, box.bottom, whole.right, whole.bottom},
          PixelBox{whole.left, box.top, box.left, box.bottom},
          {box.right, box.top, whole.right, box.bottom}};
}

ShadowedGround::ShadowedGround(const PinholeCamera& camera, double near_m, const Eigen::Matrix4f& shadow_from_world,
                               double slack_m)
    : camera_(camera),
      X_CW_(camera.X_WC.inverse()),
      near_m_(near_m),
      shadow_from_world_(shadow_from_world.cast<double>()),
      slack_m_(slack_m) {}

void ShadowedGround::add(const Eigen::Vector3d& centre, double radius_m) {
  // A square around the body in the shadow map is a parallelogram on the ground.
  const Eigen::Matrix2d map_from_ground = shadow_from_world_.topLeftCorner<2, 2>();
  const double scale = shadow_from_world_.row(0).head<3>().norm();
  if (!(std::abs(map_from_ground.determinant()) > 1e-3 * scale * scale)) {  // the light is horizontal
    bounds_.extend(Eigen::Vector2d(0.0, 0.0)).extend(Eigen::Vector2d(camera_.width, camera_.height));
    return;
  }
  const Eigen::Matrix2d ground_from_map = map_from_ground.inverse();
  const Eigen::Vector2d centre_in_map = (shadow_from_world_ * centre.homogeneous()).head<2>();
  const double reach = scale * (radius_m + kMargin_m + slack_m_);
  std::array<Eigen::Vector3d, 4> corners;  // in the camera's frame
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d in_map =
        centre_in_map + reach * Eigen::Vector2d(i == 0 || i == 3 ? -1.0 : 1.0, i < 2 ? -1.0 : 1.0);
    const Eigen::Vector2d on_ground = ground_from_map * (in_map - shadow_from_world_.topRightCorner<2, 1>());
    corners[i] = X_CW_ * Eigen::Vector3d(on_ground.x(), on_ground.y(), 0.0);
  }
  // The part of the parallelogram before the camera is projected.
  const double nearest_m = 0.5 * near_m_;
  const auto project = [&](const Eigen::Vector3d& p) {
    bounds_.extend(Eigen::Vector2d(camera_.fx * p.x() / p.z() + camera_.cx, camera_.fy * p.y() / p.z() + camera_.cy));
  };
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d &from = corners[i], &to = corners[(i + 1) % 4];
    if (from.z() >= nearest_m) project(from);
    if ((from.z() >= nearest_m) != (to.z() >= nearest_m))
      project(from + (nearest_m - from.z()) / (to.z() - from.z()) * (to - from));
  }
}

PixelBox ShadowedGround::pixels() const {
  if (bounds_.isEmpty()) return {};
  const auto below = [](double pixel, int end) {
    return static_cast<int>(std::clamp(pixel - 1.0, 0.0, static_cast<double>(end))) / kBlock * kBlock;
  };
  const auto above = [](double pixel, int end) {
    const int next = static_cast<int>(std::clamp(pixel + 2.0, 0.0, static_cast<double>(end)));
    return std::min((next + kBlock - 1) / kBlock * kBlock, end);
  };
  return {below(bounds_.min().x(), camera_.width), below(bounds_.min().y(), camera_.height),
          above(bounds_.max().x(), camera_.width), above(bounds_.max().y(), camera_.height)};
}

}  // namespace constrictor
