#include "sim/world/contact_law.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// [N s/m] Bodies that were placed so that they overlap must not be shot apart: their springs accelerate them only up
/// to the maximum correcting velocity, as if this damper acted beyond it.
constexpr double kBrake_n_s_m = 1e4;

}  // namespace

ContactLaw::ContactLaw(const SolverContact& contact, const SolverSettings& settings)
    : creep_resistance_n_s_m_(settings.creep_resistance_n_s_m),
      isotropic_(contact.friction.isotropic),
      elliptic_(settings.elliptic_friction),
      along_(contact.friction.along),
      across_(contact.friction.across) {
  if (elliptic_) {  // an ellipse without width has no slope
    constexpr double kThinnest = 1e-3;
    along_ = std::max(along_, kThinnest * across_);
    across_ = std::max(across_, kThinnest * along_);
  }
  const Vector3d& normal = contact.touch.normal;
  const Vector3d along = isotropic_ ? Vector3d(normal.unitOrthogonal()) : contact.friction.direction;
  frame_.col(0) = normal;
  frame_.col(1) = along;
  frame_.col(2) = normal.cross(along);
  // Half of h k is the least damping with which the spring is stable at each step, whatever the masses are.
  damping_n_s_m_ = std::max(settings.contact_damping_n_s_m, 0.5 * settings.step_s * settings.contact_stiffness_n_m);
  const double depth_m = std::max(0.0, contact.touch.depth_m - settings.surface_layer_m);
  resting_n_ = settings.contact_stiffness_n_m * depth_m;
  fastest_m_s_ = settings.max_correcting_velocity_m_s;
}

double ContactLaw::normal_n(double velocity_m_s) const {
  const double brake = kBrake_n_s_m * std::max(0.0, velocity_m_s - fastest_m_s_);
  return std::max(0.0, resting_n_ - damping_n_s_m_ * velocity_m_s - brake);
}

void ContactLaw::bound(const Vector3d& velocity_m_s) {
  const double normal = normal_n(velocity_m_s[0]);
  along_n_ = along_ * normal;
  across_n_ = across_ * normal;
}

// Divided by its bounds along and across, the ellipse is the unit circle. The velocity is scaled by the same factors,
// so that the law remains the gradient of a convex function; along the module a body creeps as with the rectangle.
Vector2d ContactLaw::scaled_creep(const Vector3d& velocity_m_s) const {
  if (along_n_ <= 0.0) return Vector2d::Zero();
  return creep_resistance_n_s_m_ / (along_n_ * along_n_) *
         Vector2d(along_n_ * velocity_m_s[1], across_n_ * velocity_m_s[2]);
}

Vector3d ContactLaw::force_n(const Vector3d& velocity_m_s) const {
  Vector3d force = -creep_resistance_n_s_m_ * velocity_m_s;
  force[0] = normal_n(velocity_m_s[0]);
  if (isotropic_) {
    const double friction = std::hypot(force[1], force[2]);
    if (friction > along_n_) force.tail<2>() *= along_n_ / friction;
  } else if (elliptic_) {
    const Vector2d creep_share = scaled_creep(velocity_m_s);
    const double share = std::max(1.0, creep_share.norm());
    force[1] = -along_n_ * creep_share[0] / share;
    force[2] = -across_n_ * creep_share[1] / share;
  } else {
    force[1] = std::clamp(force[1], -along_n_, along_n_);
    force[2] = std::clamp(force[2], -across_n_, across_n_);
  }
  return force;
}

ContactSlope ContactLaw::slope(const Vector3d& velocity_m_s) const {
  ContactSlope slope;
  const double creep = creep_resistance_n_s_m_;
  if (normal_n(velocity_m_s[0]) > 0.0)
    slope.add(Vector3d::UnitX(), damping_n_s_m_ + (velocity_m_s[0] > fastest_m_s_ ? kBrake_n_s_m : 0.0));
  if (isotropic_) {
    const double speed = std::hypot(velocity_m_s[1], velocity_m_s[2]);
    if (creep * speed < along_n_) {
      slope.add(Vector3d::UnitY(), creep);
      slope.add(Vector3d::UnitZ(), creep);
    } else if (along_n_ > 0.0) {  // a sliding force turns with the velocity, but its amount stays
      slope.add(Vector3d(0.0, -velocity_m_s[2] / speed, velocity_m_s[1] / speed), along_n_ / speed);
    }
    return slope;
  }
  if (elliptic_) {
    if (along_n_ <= 0.0 || across_n_ <= 0.0) return slope;
    const Vector2d creep_share = scaled_creep(velocity_m_s);
    const double amount = creep_share.norm();
    const double widened = across_n_ / along_n_;
    if (amount < 1.0) {
      slope.add(Vector3d::UnitY(), creep);
      slope.add(Vector3d::UnitZ(), creep * widened * widened);
    } else {  // as above, with both axes scaled to those of the ellipse
      const Vector3d axis(0.0, -along_n_ * creep_share[1], across_n_ * creep_share[0]);
      slope.add(axis.normalized(), creep / (along_n_ * along_n_) * axis.squaredNorm() / (amount * amount * amount));
    }
    return slope;
  }
  if (creep * std::abs(velocity_m_s[1]) < along_n_) slope.add(Vector3d::UnitY(), creep);
  if (creep * std::abs(velocity_m_s[2]) < across_n_) slope.add(Vector3d::UnitZ(), creep);
  return slope;
}

}  // namespace constrictor
