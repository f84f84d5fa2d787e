#include "sim/world/collision.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {
namespace {

using Eigen::Vector3d;

struct Nearest {
  Vector3d point;     ///< on the surface of the solid
  Vector3d normal;    ///< outwards
  double distance_m;  ///< negative inside
};

/// Point of the solid that is nearest to `p`, both in the solid's frame; `p` itself if it lies inside.
Vector3d project(const ConvexSolid& solid, const Vector3d& p) {
  if (solid.shape == BodyShape::kBox) {
    const Vector3d half = 0.5 * solid.size_m;
    return p.cwiseMax(-half).cwiseMin(half);
  }
  const double half_height = 0.5 * solid.size_m.z();
  const double radius = solid.size_m.x();
  const double r = p.head<2>().norm();
  const double scale = r > radius ? radius / r : 1.0;
  return {p.x() * scale, p.y() * scale, std::clamp(p.z(), -half_height, half_height)};
}

/// The nearest point of the surface for a point inside the solid.
Nearest leave(const ConvexSolid& solid, const Vector3d& p) {
  if (solid.shape == BodyShape::kBox) {
    const Vector3d room = 0.5 * solid.size_m - p.cwiseAbs();
    int axis = 0;
    room.minCoeff(&axis);
    Vector3d normal = Vector3d::Zero();
    normal[axis] = p[axis] < 0.0 ? -1.0 : 1.0;
    return {p + normal * room[axis], normal, -room[axis]};
  }
  const double r = p.head<2>().norm();
  const double room_side = solid.size_m.x() - r;
  const double room_end = 0.5 * solid.size_m.z() - std::abs(p.z());
  if (room_side <= room_end) {
    const Vector3d normal = r > 1e-9 ? Vector3d(p.x() / r, p.y() / r, 0.0) : Vector3d::UnitX();
    return {p + normal * room_side, normal, -room_side};
  }
  const Vector3d normal(0.0, 0.0, p.z() < 0.0 ? -1.0 : 1.0);
  return {p + normal * room_end, normal, -room_end};
}

Nearest nearest(const ConvexSolid& solid, const Vector3d& p) {
  const Vector3d q = project(solid, p);
  const Vector3d away = p - q;
  const double distance = away.norm();
  if (distance < 1e-12) return leave(solid, p);
  return {q, away / distance, distance};
}

/// The t in [0, 1] at which a + t d is nearest to the solid. The derivative of the distance never decreases with t, so
/// bisection finds where it changes its sign.
double nearest_parameter(const ConvexSolid& solid, const Vector3d& a, const Vector3d& d) {
  const auto slope = [&](double t) {
    const Vector3d p = a + t * d;
    return (p - project(solid, p)).dot(d);
  };
  if (slope(0.0) >= 0.0) return 0.0;
  if (slope(1.0) <= 0.0) return 1.0;
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) < 0.0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

void touch_capsule_solid(const Capsule& capsule, const ConvexSolid& solid, TouchPoints& touches) {
  const Eigen::Isometry3d X_SW = solid.X_WS.inverse(Eigen::Isometry);
  const Vector3d a = X_SW * capsule.front;
  const Vector3d d = X_SW * capsule.back - a;
  const auto emit = [&](const Nearest& at) {
    touches.add({solid.X_WS * at.point, solid.X_WS.linear() * at.normal, capsule.radius_m - at.distance_m});
  };
  const double t = nearest_parameter(solid, a, d);
  const Nearest middle = nearest(solid, a + t * d);
  if (middle.distance_m >= capsule.radius_m) return;
  double nearest_end = capsule.radius_m;
  for (const double end : {0.0, 1.0}) {
    const Nearest at = nearest(solid, a + end * d);
    if (at.distance_m >= capsule.radius_m) continue;
    emit(at);
    nearest_end = std::min(nearest_end, at.distance_m);
  }
  if (middle.distance_m < nearest_end - 1e-7) emit(middle);
}

void touch_capsules(const Capsule& first, const Capsule& second, TouchPoints& touches) {
  // Closest points of two segments. Source: C. Ericson, Real-Time Collision Detection, 5.1.9.
  const Vector3d d1 = first.back - first.front;
  const Vector3d d2 = second.back - second.front;
  const Vector3d r = first.front - second.front;
  const double a = d1.squaredNorm();
  const double e = d2.squaredNorm();
  const double f = d2.dot(r);
  const double c = d1.dot(r);
  const double b = d1.dot(d2);
  const double denominator = a * e - b * b;
  double s = denominator > 1e-12 * a * e ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.5;
  double t = (b * s + f) / e;
  if (t < 0.0) {
    t = 0.0;
    s = std::clamp(-c / a, 0.0, 1.0);
  } else if (t > 1.0) {
    t = 1.0;
    s = std::clamp((b - c) / a, 0.0, 1.0);
  }
  const Vector3d on_first = first.front + s * d1;
  const Vector3d on_second = second.front + t * d2;
  const Vector3d away = on_first - on_second;
  const double distance = away.norm();
  const double depth = first.radius_m + second.radius_m - distance;
  if (depth <= 0.0) return;
  const Vector3d normal = distance > 1e-9 ? Vector3d(away / distance) : Vector3d::UnitZ();
  touches.add({on_second + normal * (second.radius_m - 0.5 * depth), normal, depth});
}

void touch_solid_ground(const ConvexSolid& solid, TouchPoints& touches) {
  const auto emit = [&](const Vector3d& p) {
    if (p.z() < 0.0) touches.add({p, Vector3d::UnitZ(), -p.z()});
  };
  const Eigen::Matrix3d& R = solid.X_WS.linear();
  if (solid.shape == BodyShape::kBox) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3d sign(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      emit(solid.X_WS * solid.size_m.cwiseProduct(sign));
    }
    return;
  }
  const Vector3d axis = R.col(2);
  // Four points on each rim, beginning with the deepest one. An upright cylinder has no deepest point; there the points
  // are fixed in the body.
  Vector3d down = -Vector3d::UnitZ() + axis * axis.z();
  const double tilt = down.norm();
  down = tilt > 1e-3 ? Vector3d(down / tilt) : Vector3d(R.col(0));
  const Vector3d across = axis.cross(down);
  for (const double side : {-0.5, 0.5}) {
    const Vector3d centre = solid.X_WS.translation() + axis * (side * solid.size_m.z());
    for (const Vector3d& direction : {down, Vector3d(-down), across, Vector3d(-across)}) {
      emit(centre + direction * solid.size_m.x());
    }
  }
}

}  // namespace constrictor
