#include "conform/synthetic_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "conform/tick_period.hpp"
#include "constrictor/colours.hpp"
#include "robot/camera_mount.hpp"
#include "robot/pose_message.hpp"

namespace constrictor::conform {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSub = 2;  // rays in each direction of a pixel
const Vector3d kGround(0.50, 0.49, 0.47), kSky(0.66, 0.68, 0.72);

Vector3d paint_of(std::uint8_t colour) {
  const Rgb8& screen = look_of(colour).screen;
  return Vector3d(screen[0], screen[1], screen[2]) / 255.0;
}

/// The distance along a ray at which it meets a cylinder, and how bright the surface is there; none if it misses.
struct Hit {
  double along = std::numeric_limits<double>::infinity();
  double bright = 1.0;
};

Hit meet(const Standing& body, const Vector3d& eye, const Vector3d& ray) {
  Hit hit;
  if (body.height_m <= 0.0) return hit;
  const Vector2d from(eye.x() - body.x_m, eye.y() - body.y_m), along = ray.head<2>();
  const double a = along.squaredNorm(), half_b = from.dot(along);
  const double root = half_b * half_b - a * (from.squaredNorm() - body.radius_m * body.radius_m);
  if (root > 0.0 && a > 0.0) {
    const double t = (-half_b - std::sqrt(root)) / a, z = eye.z() + t * ray.z();
    if (t > 0.0 && z >= 0.0 && z <= body.height_m) {
      const Vector2d normal = (from + t * along) / body.radius_m;
      hit = {t, 0.75 + 0.2 * normal.y()};  // the light comes from the left
    }
  }
  const double top = (body.height_m - eye.z()) / ray.z();
  if (top > 0.0 && top < hit.along && (from + top * along).norm() <= body.radius_m) hit = {top, 1.0};
  return hit;
}

Vector3d colour_of(const SyntheticScene& scene, const Vector3d& eye, const Vector3d& ray) {
  Hit nearest;
  Vector3d colour = kSky;
  for (const Standing& body : scene.standing) {
    const Hit hit = meet(body, eye, ray);
    if (hit.along >= nearest.along) continue;
    nearest = hit;
    colour = hit.bright * paint_of(body.colour);
  }
  const double down = ray.z() < -1e-9 ? -eye.z() / ray.z() : std::numeric_limits<double>::infinity();
  if (!(down < nearest.along)) return colour;
  const Vector2d point = (eye + down * ray).head<2>();
  colour = kGround;
  for (const Standing& disc : scene.standing) {
    if (disc.height_m <= 0.0 && (point - Vector2d(disc.x_m, disc.y_m)).norm() <= disc.radius_m)
      colour = paint_of(disc.colour);
  }
  if (scene.line && scene.line->distance_m(point) <= 0.5 * scene.line->width_m) colour = paint_of(scene.line->colour);
  return colour;
}

}  // namespace

Vector2d PaintedLine::at(double length) const {
  const Vector2d begin(begin_x_m, begin_y_m);
  if (std::abs(curvature_1_m) < 1e-9) return begin + length * Vector2d(std::cos(heading_rad), std::sin(heading_rad));
  const double end_rad = heading_at(length);
  return begin +
         Vector2d(std::sin(end_rad) - std::sin(heading_rad), std::cos(heading_rad) - std::cos(end_rad)) / curvature_1_m;
}

double PaintedLine::length_at_x(double x_m) const {
  constexpr double kStep_m = 0.001;
  double length = 0.0;
  while (length < length_m && at(length).x() < x_m) length += kStep_m;
  return length;
}

double PaintedLine::distance_m(const Vector2d& point) const {
  constexpr double kFar_m = 1e3;
  const Vector2d begin(begin_x_m, begin_y_m), ahead(std::cos(heading_rad), std::sin(heading_rad));
  const Vector2d left(-ahead.y(), ahead.x()), way = point - begin;
  if (std::abs(curvature_1_m) < 1e-9) {
    const double along = way.dot(ahead);
    return along < 0.0 || along > length_m ? kFar_m : std::abs(way.dot(left));
  }
  const double radius = 1.0 / curvature_1_m;  // positive: the centre is on the left
  const Vector2d from_centre = way - radius * left;
  // The line begins on the side of the centre that is opposite to `left` (or on it, if it bends to the right).
  const double turned = std::atan2(from_centre.dot(ahead), (radius > 0.0 ? -1.0 : 1.0) * from_centre.dot(left));
  const double along = std::abs(radius) * turned;
  return along < 0.0 || along > length_m ? kFar_m : std::abs(from_centre.norm() - std::abs(radius));
}

SyntheticCamera::SyntheticCamera(const RobotModel& robot)
    : model_(robot.camera),
      focal_pixels_(0.5 * robot.camera.width / std::tan(0.5 * robot.camera.horizontal_fov_rad)),
      head_height_m_(robot.module_radius_m),
      period_s_(kTick_s * robot.camera.period_ticks) {}

msg::CameraInfo SyntheticCamera::info() const {
  msg::CameraInfo info{};
  info.width = static_cast<std::uint16_t>(model_.width);
  info.height = static_cast<std::uint16_t>(model_.height);
  info.fx = info.fy = focal_pixels_;
  info.cx = 0.5 * model_.width;
  info.cy = 0.5 * model_.height;
  info.X_HC = pose_message(camera_mount(model_));
  info.frame_period_s = period_s_;
  return info;
}

Eigen::Isometry3d SyntheticCamera::pose(const SyntheticScene& scene) const {
  Eigen::Isometry3d X_GH = Eigen::Isometry3d::Identity();
  X_GH.translation().z() = head_height_m_;
  X_GH.rotate(Eigen::AngleAxisd(scene.pitch_rad, Vector3d::UnitY()));
  X_GH.rotate(Eigen::AngleAxisd(scene.roll_rad, Vector3d::UnitX()));
  return X_GH * camera_mount(model_);
}

msg::Quaternion SyntheticCamera::attitude(const SyntheticScene& scene) {
  const Eigen::Quaterniond q =
      Eigen::AngleAxisd(scene.pitch_rad, Vector3d::UnitY()) * Eigen::AngleAxisd(scene.roll_rad, Vector3d::UnitX());
  return {q.w(), q.x(), q.y(), q.z()};
}

std::vector<std::uint8_t> SyntheticCamera::draw(const SyntheticScene& scene) const {
  const Eigen::Isometry3d X_GC = pose(scene);
  const Vector3d eye = X_GC.translation();
  const Eigen::Matrix3d R_GC = X_GC.linear();
  std::vector<std::uint8_t> rgb;
  rgb.reserve(static_cast<std::size_t>(model_.width * model_.height * 3));
  for (int v = 0; v < model_.height; ++v) {
    for (int u = 0; u < model_.width; ++u) {
      Vector3d sum = Vector3d::Zero();
      for (int i = 0; i < kSub * kSub; ++i) {
        const int column = i % kSub, row = i / kSub;
        const double at_u = u + (column + 0.5) / kSub, at_v = v + (row + 0.5) / kSub;
        const Vector3d ray((at_u - 0.5 * model_.width) / focal_pixels_, (at_v - 0.5 * model_.height) / focal_pixels_,
                           1.0);
        sum += colour_of(scene, eye, R_GC * ray) / (kSub * kSub);
      }
      for (int channel = 0; channel < 3; ++channel)
        rgb.push_back(static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(scene.light * sum[channel], 0.0, 1.0))));
    }
  }
  return rgb;
}

void SyntheticCamera::add_noise(std::vector<std::uint8_t>& rgb, double noise, std::uint64_t seed) {
  std::uint64_t state = 0x9e3779b97f4a7c15 * (seed + 1);
  for (std::uint8_t& level : rgb) {
    double sum = 0.0;  // of three uniform numbers: nearly normal, with a variance of 1/4
    for (int i = 0; i < 3; ++i) {
      state = state * 6364136223846793005 + 1442695040888963407;
      sum += static_cast<double>(state >> 40) / static_cast<double>(1 << 24) - 0.5;
    }
    level = static_cast<std::uint8_t>(std::lround(std::clamp(level + 255.0 * noise * 2.0 * sum, 0.0, 255.0)));
  }
}

Vector2d SyntheticCamera::pixel(const Vector3d& point) const {
  const Vector3d p = pose({}).inverse() * point;
  return {0.5 * model_.width + focal_pixels_ * p.x() / p.z(), 0.5 * model_.height + focal_pixels_ * p.y() / p.z()};
}

}  // namespace constrictor::conform
