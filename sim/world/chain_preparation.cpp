// The part of ChainDynamics that sets the equations of a step up.
#include "sim/world/chain_dynamics.hpp"

namespace constrictor {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The rate of change of a free body's angular velocity that its rotation causes in a step, by one step of Newton's
/// method on the implicit equation; the explicit one would gain energy. Source: E. Catto, Numerical Methods (GDC 2015).
Vector3d gyroscopic_change(const Vector3d& inertia, const Matrix3d& R_WB, const Vector3d& w_W, double step_s) {
  const Vector3d w = R_WB.transpose() * w_W;
  const Vector3d momentum = inertia.cwiseProduct(w);
  const Matrix3d J = Matrix3d(inertia.asDiagonal()) + step_s * (skew(w) * inertia.asDiagonal() - skew(momentum));
  return R_WB * Vector3d(-J.inverse() * (step_s * w.cross(momentum)));
}

}  // namespace

// Velocities about the centre of the head; impulses of the external forces and of the acceleration that the modules
// would have if the generalised velocities did not change.
void ChainDynamics::prepare_chain() {
  const Vector3d& p_WRef = bodies_[0].position_m;
  Vector3d angular = Vector3d::Zero();  // acceleration
  Vector3d linear = Vector3d::Zero();   // of the centre
  for (std::size_t k = 0; k < module_count(); ++k) {
    const BodyMotion& body = bodies_[k];
    const Vector3d& w = body.angular_velocity_rad_s;
    if (k > 0) {
      const BodyMotion& ahead = bodies_[k - 1];
      const Vector3d& w_ahead = ahead.angular_velocity_rad_s;
      const Vector3d a = axis(k - 1);
      const Vector3d to_joint = -half_length_m_ * ahead.R_WB.col(0);
      const Vector3d from_joint = -half_length_m_ * body.R_WB.col(0);
      const Vector3d p = ahead.position_m + to_joint - p_WRef;
      system_.joints()[k - 1].axis = spatial(-a, p.cross(-a));
      linear += angular.cross(to_joint) + w_ahead.cross(w_ahead.cross(to_joint));
      angular -= w_ahead.cross(rates_rad_s_[k - 1] * a);
      linear += angular.cross(from_joint) + w.cross(w.cross(from_joint));
    }
    drifts_[k] = {angular, linear};
    const Matrix3d inertia = inertia_W(k);
    const double mass = inertial_[k].mass_kg;
    const Vector3d c = body.position_m - p_WRef;
    const Vector3d force = external_[k].force_n + mass * (gravity_m_s2_ - linear);
    const Vector3d torque = external_[k].torque_nm - inertia * angular - w.cross(inertia * w);
    SystemBody& solved = system_.bodies()[k];
    solved.inertia = spatial_inertia(mass, inertia, c);
    solved.velocity = spatial(w, body.velocity_m_s - w.cross(c));
    solved.impulse = settings_.step_s * (at_point(c, force) + spatial(torque, Vector3d::Zero()));
  }
}

void ChainDynamics::prepare_joints(std::span<const ServoRow> rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ChainSystem::Joint& joint = system_.joints()[i];
    joint.rate_rad_s = rates_rad_s_[i];
    joint.servo = rows[i];
    // Like ODE's stops, this corrects a share of the error in each step.
    const double low_rad = models_[i].min_rad - angles_rad_[i];
    const double high_rad = models_[i].max_rad - angles_rad_[i];
    joint.stop_side = low_rad > 0.0 ? 1.0 : high_rad < 0.0 ? -1.0 : 0.0;
    joint.stop.velocity_rad_s = settings_.erp / settings_.step_s * (low_rad > 0.0 ? low_rad : high_rad);
    joint.stop.softness = settings_.cfm;
  }
}

void ChainDynamics::prepare_object(std::size_t body) {
  const BodyMotion& state = bodies_[body];
  const Matrix3d inertia = inertia_W(body);
  const double mass = inertial_[body].mass_kg;
  const double h = settings_.step_s;
  SystemBody& solved = system_.bodies()[body];
  solved.inertia.setZero();
  solved.inertia.topLeftCorner<3, 3>() = inertia;
  solved.inertia.bottomRightCorner<3, 3>() = mass * Matrix3d::Identity();
  solved.velocity = spatial(state.angular_velocity_rad_s, state.velocity_m_s);
  const Vector3d turn = gyroscopic_change(inertial_[body].inertia_kg_m2, state.R_WB, state.angular_velocity_rad_s, h);
  solved.impulse =
      spatial(h * external_[body].torque_nm + inertia * turn, h * (external_[body].force_n + mass * gravity_m_s2_));
}

// While joints and body turn, a point does not move along the straight line of its velocity: in a step of h it moves by
// h (v + h/2 a), with the acceleration a that it has at constant generalised velocities. Without the second term a body
// that rolls would slip a little in each step. The point is the one of the module's axis above the contact, because the
// surface of a round body rolls on.
Vector3d ChainDynamics::drift_m_s(const SolverContact& contact, std::size_t module) const {
  if (module >= module_count()) return Vector3d::Zero();
  const BodyMotion& body = bodies_[module];
  const Vector3d normal = module == contact.first ? contact.touch.normal : Vector3d(-contact.touch.normal);
  const Vector3d on_axis = contact.touch.position_m + radius_m_ * normal - body.position_m;
  const Vector3d& w = body.angular_velocity_rad_s;
  const auto& [angular, linear] = drifts_[module];
  const Vector3d acceleration =
      linear + w.cross(w.cross(on_axis)) + angular.cross(contact.touch.position_m - body.position_m);
  return 0.5 * settings_.step_s * acceleration;
}

void ChainDynamics::prepare_contacts(std::span<const SolverContact> contacts) {
  std::vector<ChainSystem::Contact>& prepared = system_.contacts();
  prepared.clear();
  for (const SolverContact& contact : contacts) {
    ChainSystem::Contact& row = prepared.emplace_back(
        ChainSystem::Contact{contact.first, contact.second, {}, {}, ContactLaw(contact, settings_)});
    for (int i = 0; i < 3; ++i) {
      const Vector3d direction = row.law.frame().col(i);
      row.on_first.col(i) = at_point(contact.touch.position_m - reference(contact.first), direction);
      if (contact.second != kFixed)
        row.on_second.col(i) = at_point(contact.touch.position_m - reference(contact.second), direction);
    }
    row.drift_m_s =
        row.law.frame().transpose() * (drift_m_s(contact, contact.first) - drift_m_s(contact, contact.second));
  }
}

}  // namespace constrictor
