#include "perception/ground_camera.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot/rotation.hpp"

namespace constrictor::perception {
namespace {

constexpr double kLeastHeight_m = 1e-3;  // keeps a camera above the ground, also if its module lies on its side

}  // namespace

GroundCamera::GroundCamera(const msg::CameraInfo& info, const HeadShape& head, OwnBody body)
    : width_(info.width),
      height_(info.height),
      fx_(info.fx),
      fy_(info.fy),
      cx_(info.cx),
      cy_(info.cy),
      head_(head),
      body_(std::move(body)) {}

GroundCamera::GroundCamera(const msg::CameraInfo& info, const msg::Quaternion& orientation, double head_height_m,
                           const HeadShape& head, OwnBody body)
    : GroundCamera(info, head, std::move(body)) {
  const Eigen::Matrix3d R_WH = rotation_from(orientation);
  const double yaw = std::atan2(R_WH(1, 0), R_WH(0, 0));
  Eigen::Matrix3d R_GW;
  R_GW << std::cos(yaw), std::sin(yaw), 0, -std::sin(yaw), std::cos(yaw), 0, 0, 0, 1;
  const Eigen::Matrix3d R_GH = R_GW * R_WH;
  const auto& p = info.X_HC.position_m;
  R_HC_ = rotation_from(info.X_HC.orientation);
  p_HC_ = Eigen::Vector3d(p.x, p.y, p.z);
  R_GC_ = R_GH * R_HC_;
  p_GC_ = R_GH * p_HC_ + Eigen::Vector3d(0, 0, head_height_m);
  p_GC_.z() = std::max(p_GC_.z(), kLeastHeight_m);
  find_clear_side();
}

GroundCamera::GroundCamera(const msg::CameraInfo& info, const Eigen::Isometry3d& X_VC, OwnBody body)
    : GroundCamera(info, HeadShape{}, std::move(body)) {
  R_GC_ = X_VC.linear();
  p_GC_ = X_VC.translation();
  p_GC_.z() = std::max(p_GC_.z(), kLeastHeight_m);
}

void GroundCamera::find_clear_side() {
  // The head lies behind a plane through the camera that touches one end of it and has the other end behind it, too. A
  // ray towards the front of such a plane cannot come near the head. The plane with most of the view before it is
  // taken.
  const double reach_m = head_reach_m() + 1e-6;
  const Eigen::Vector3d view = R_HC_.col(2);
  double best = -2.0;
  for (const double end : {-head_.half_length_m, head_.half_length_m}) {
    const Eigen::Vector3d from_end = p_HC_ - Eigen::Vector3d(end, 0.0, 0.0);
    const Eigen::Vector3d from_other = p_HC_ + Eigen::Vector3d(end, 0.0, 0.0);
    const double distance_m = from_end.norm();
    if (!(distance_m > reach_m)) continue;
    const Eigen::Vector3d away = from_end / distance_m;
    Eigen::Vector3d along = view - view.dot(away) * away;
    if (along.norm() < 1e-6) continue;
    along.normalize();
    const double cosine = reach_m / distance_m;
    const Eigen::Vector3d normal = cosine * away + std::sqrt(1.0 - cosine * cosine) * along;
    if (normal.dot(from_other) < reach_m - 1e-9 || normal.dot(view) <= best) continue;
    best = normal.dot(view);
    clear_ = R_HC_.transpose() * normal;
  }
}

bool GroundCamera::own_body(double u, double v) const {
  const Eigen::Vector3d ray_C((u - cx_) / fx_, (v - cy_) / fy_, 1.0);
  if (sees_body() && body_.covers(ray_C, 2.0 / fx_)) return true;
  if (head_.radius_m <= 0.0) return false;
  if (clear_.dot(ray_C) > 1e-9) return false;
  const Eigen::Vector3d d = (R_HC_ * ray_C).normalized();
  // Least distance between the ray and the axis of the capsule.
  double s = std::clamp(p_HC_.x(), -head_.half_length_m, head_.half_length_m), t = 0.0;
  for (int i = 0; i < 4; ++i) {  // projects onto the segment and the ray in turn
    t = std::max(0.0, (Eigen::Vector3d(s, 0.0, 0.0) - p_HC_).dot(d));
    s = std::clamp(p_HC_.x() + t * d.x(), -head_.half_length_m, head_.half_length_m);
  }
  return (p_HC_ + t * d - Eigen::Vector3d(s, 0.0, 0.0)).norm() < head_reach_m();
}

std::optional<Eigen::Vector2d> GroundCamera::ground(double u, double v, double max_range_m) const {
  const Eigen::Vector3d direction = ray(u, v);
  if (direction.z() >= -1e-9) return std::nullopt;
  const Eigen::Vector2d along = direction.head<2>() * (-p_GC_.z() / direction.z());
  if (along.squaredNorm() > max_range_m * max_range_m) return std::nullopt;
  return Eigen::Vector2d(p_GC_.head<2>() + along);
}

std::optional<Eigen::Vector2d> GroundCamera::pixel(const Eigen::Vector3d& p_G) const {
  const Eigen::Vector3d p_C = R_GC_.transpose() * (p_G - p_GC_);
  if (p_C.z() < 1e-6) return std::nullopt;
  return Eigen::Vector2d(cx_ + fx_ * p_C.x() / p_C.z(), cy_ + fy_ * p_C.y() / p_C.z());
}

double GroundCamera::horizon_row(double u) const {
  // ray(u, v).z = 0
  const double slope = R_GC_(2, 1);
  if (std::abs(slope) < 1e-6) return 1e9;
  return cy_ - fy_ * (R_GC_(2, 0) * (u - cx_) / fx_ + R_GC_(2, 2)) / slope;
}

int GroundCamera::horizon_pixel(int column) const {
  return static_cast<int>(std::clamp(std::floor(horizon_row(column + 0.5)), -1e6, 1e6));
}

}  // namespace constrictor::perception
