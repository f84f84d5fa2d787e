#include "ray_caster.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace constrictor::testing {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const Vector3d kPaint[msg::kColourCount] = {
    {0.5, 0.5, 0.5}, {0.10, 0.65, 0.15}, {0.80, 0.10, 0.08}, {0.08, 0.20, 0.80}, {0.85, 0.75, 0.08}};

/// Whether a point lies on the painted line: within half of its width from the arc, and between the ends of the arc.
bool on_arc(const Arc& arc, const Vector2d& p) {
  const Vector2d t(std::cos(arc.heading_rad), std::sin(arc.heading_rad)), n(-t.y(), t.x());
  const Vector2d d = p - arc.start;
  if (std::abs(arc.curvature_1_m) < 1e-6) {
    const double s = d.dot(t);
    return s >= 0.0 && s <= arc.length_m && std::abs(d.dot(n)) <= 0.5 * arc.width_m;
  }
  const double radius = 1.0 / arc.curvature_1_m;
  const Vector2d centre = arc.start + radius * n;
  const Vector2d r = p - centre;
  if (std::abs(r.norm() - std::abs(radius)) > 0.5 * arc.width_m) return false;
  // The angle from the start of the arc, positive in the direction in which the arc turns.
  const Vector2d from = -radius * n;
  double angle = std::atan2(from.x() * r.y() - from.y() * r.x(), from.dot(r));
  if (radius < 0.0) angle = -angle;
  const double s = angle * std::abs(radius);
  return s >= 0.0 && s <= arc.length_m;
}

/// Distance along a ray to the side or the top of an upright cylinder; negative if the ray misses it.
double hit(const Round& c, const Vector3d& o, const Vector3d& d, Vector3d& normal) {
  if (c.height_m <= 0.0) return -1.0;
  const Vector2d oc = o.head<2>() - c.centre;
  const double a = d.head<2>().squaredNorm(), b = oc.dot(d.head<2>()), q = oc.squaredNorm() - c.radius_m * c.radius_m;
  double best = -1.0;
  if (a > 1e-12 && b * b - a * q > 0.0) {
    const double t = (-b - std::sqrt(b * b - a * q)) / a;
    const double z = o.z() + t * d.z();
    if (t > 1e-6 && z >= 0.0 && z <= c.height_m) {
      best = t;
      const Vector2d n = (oc + t * d.head<2>()) / c.radius_m;
      normal = {n.x(), n.y(), 0.0};
    }
  }
  if (d.z() != 0.0) {
    const double t = (c.height_m - o.z()) / d.z();
    if (t > 1e-6 && (oc + t * d.head<2>()).norm() <= c.radius_m && (best < 0.0 || t < best)) {
      best = t;
      normal = Vector3d::UnitZ();
    }
  }
  return best;
}

Vector3d shade(const Scene& scene, const Vector3d& paint, const Vector3d& p, const Vector3d& normal) {
  const Vector3d light = scene.light.normalized();
  double direct = std::max(0.0, normal.dot(light)) * (1.0 - scene.ambient);
  for (const Round& c : scene.rounds) {
    Vector3d n;
    if (hit(c, p + 1e-4 * normal, light, n) > 1e-3) direct = 0.0;
  }
  return paint * (scene.ambient + direct) * scene.light_intensity;
}

Vector3d trace(const Scene& scene, const Vector3d& o, const Vector3d& d) {
  double nearest = 1e9;
  Vector3d colour(0.62, 0.64, 0.68);  // background
  Vector3d normal;
  for (const Round& c : scene.rounds) {
    const double t = hit(c, o, d, normal);
    if (t > 0.0 && t < nearest) {
      nearest = t;
      colour = shade(scene, kPaint[c.colour], o + t * d, normal);
    }
  }
  if (d.z() < 0.0 && -o.z() / d.z() < nearest) {
    const Vector3d p = o - o.z() / d.z() * d;
    Vector3d paint(0.55, 0.54, 0.52);
    for (const Round& c : scene.rounds) {
      if (c.height_m <= 0.0 && (p.head<2>() - c.centre).norm() <= c.radius_m) paint = kPaint[c.colour];
    }
    if (scene.line && on_arc(*scene.line, p.head<2>())) paint = kPaint[scene.line->colour];
    colour = shade(scene, paint, p, Vector3d::UnitZ());
  }
  return colour;
}

Eigen::Matrix3d axes(const Head& head, bool with_yaw) {
  const Eigen::AngleAxisd yaw(with_yaw ? head.yaw_rad : 0.0, Vector3d::UnitZ()),
      pitch(head.pitch_rad, Vector3d::UnitY()), roll(head.roll_rad, Vector3d::UnitX());
  return (yaw * pitch * roll).toRotationMatrix();
}

Eigen::Matrix3d mount(double tilt_rad) {
  Eigen::Matrix3d R;  // columns: the directions right, down and ahead of the camera, in the head's frame
  R.col(0) = Vector3d(0, -1, 0);
  R.col(1) = Vector3d(-std::sin(tilt_rad), 0, -std::cos(tilt_rad));
  R.col(2) = Vector3d(std::cos(tilt_rad), 0, -std::sin(tilt_rad));
  return R;
}

msg::Quaternion to_message(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  return {q.w(), q.x(), q.y(), q.z()};
}

}  // namespace

Vector2d Arc::at(double s) const {
  const Vector2d t(std::cos(heading_rad), std::sin(heading_rad)), n(-t.y(), t.x());
  if (std::abs(curvature_1_m) < 1e-6) return start + s * t;
  const double a = curvature_1_m * s;
  return start + std::sin(a) / curvature_1_m * t + (1.0 - std::cos(a)) / curvature_1_m * n;
}

std::optional<double> Arc::length_at_x(double x_m) const {
  for (double s = 0.0; s < length_m; s += 0.0005) {
    if ((at(s).x() <= x_m) != (at(s + 0.0005).x() <= x_m)) return s;
  }
  return std::nullopt;
}

msg::CameraInfo camera_info(int width, int height, double horizontal_fov_rad, double tilt_rad) {
  msg::CameraInfo info{};
  info.width = static_cast<std::uint16_t>(width);
  info.height = static_cast<std::uint16_t>(height);
  info.fx = info.fy = 0.5 * width / std::tan(0.5 * horizontal_fov_rad);
  info.cx = 0.5 * width;
  info.cy = 0.5 * height;
  info.X_HC.position_m = {0.03, 0.0, 0.05};
  info.X_HC.orientation = to_message(mount(tilt_rad));
  info.frame_period_s = 0.1;
  return info;
}

msg::Quaternion orientation(const Head& head) { return to_message(axes(head, true)); }

cv::Mat draw(const Scene& scene, const msg::CameraInfo& info, const Head& head, double tilt_rad) {
  const Eigen::Matrix3d R_GH = axes(head, false);
  const Eigen::Matrix3d R_GC = R_GH * mount(tilt_rad);
  const auto& m = info.X_HC.position_m;
  const Vector3d eye = R_GH * Vector3d(m.x, m.y, m.z) + Vector3d(0, 0, head.height_m);
  std::mt19937_64 random(scene.seed);
  std::normal_distribution<double> noise(0.0, scene.noise_sd > 0.0 ? scene.noise_sd : 1.0);
  cv::Mat image(info.height, info.width, CV_8UC3);
  constexpr int kSub = 2;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      Vector3d sum = Vector3d::Zero();
      for (int k = 0; k < kSub * kSub; ++k) {
        const int column = k % kSub, row = k / kSub;
        const double pu = u + (column + 0.5) / kSub, pv = v + (row + 0.5) / kSub;
        sum += trace(scene, eye, R_GC * Vector3d((pu - info.cx) / info.fx, (pv - info.cy) / info.fy, 1.0));
      }
      sum /= kSub * kSub;
      for (int c = 0; c < 3; ++c) {
        double level = scene.gamma ? std::pow(std::clamp(sum[c], 0.0, 1.0), 1.0 / 2.2) : sum[c];
        if (scene.noise_sd > 0.0) level += noise(random);
        image.at<cv::Vec3b>(v, u)[c] =
            cv::saturate_cast<std::uint8_t>(std::lround(255.0 * std::clamp(level, 0.0, 1.0)));
      }
    }
  }
  return image;
}

}  // namespace constrictor::testing
