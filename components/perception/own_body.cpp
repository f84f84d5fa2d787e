#include "perception/own_body.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace constrictor::perception {
namespace {

constexpr double kSlack_m = 0.002;  // for errors of the measured angles

}  // namespace

OwnBody::OwnBody(const std::vector<Eigen::Isometry3d>& X_CM, double half_length_m, double radius_m)
    : reach_m_(radius_m + kSlack_m) {
  for (const Eigen::Isometry3d& X : X_CM) {
    const Eigen::Vector3d arm = half_length_m * X.linear().col(0);
    const double distance_m = X.translation().norm(), extent_m = half_length_m + reach_m_;
    const double half_rad = distance_m > extent_m ? std::asin(extent_m / distance_m) : std::numbers::pi;
    modules_.push_back({X.translation() + arm, X.translation() - arm, X.translation().normalized(), half_rad});
  }
}

bool OwnBody::covers(const Eigen::Vector3d& ray_C, double margin_rad) const {
  const Eigen::Vector3d d = ray_C.normalized();
  return std::any_of(modules_.begin(), modules_.end(), [&](const Module& module) {
    const double wide_rad = module.half_rad + margin_rad;
    if (wide_rad < std::numbers::pi && d.dot(module.direction) < std::cos(wide_rad)) return false;
    // Least distance between the ray (at t) and the straight part (at s): projects onto each of them in turn.
    const Eigen::Vector3d along = module.back - module.front;
    const double square = along.squaredNorm();
    double s = 0.5, t = 0.0;
    for (int i = 0; i < 8; ++i) {
      t = std::max(0.0, (module.front + s * along).dot(d));
      s = std::clamp((t * d - module.front).dot(along) / square, 0.0, 1.0);
    }
    t = std::max(0.0, (module.front + s * along).dot(d));
    return (t * d - module.front - s * along).norm() < reach_m_ + margin_rad * t;
  });
}

}  // namespace constrictor::perception
