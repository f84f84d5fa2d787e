#include "sim/world/chain_dynamics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace constrictor {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// The rotation by which a body turns in a time at a constant angular velocity.
Quaterniond turned(const Quaterniond& q_WB, const Vector3d& angular_velocity_rad_s, double duration_s) {
  const Vector3d half = 0.5 * duration_s * angular_velocity_rad_s;
  const double angle = half.norm();
  const double share = angle > 1e-8 ? std::sin(angle) / angle : 1.0 - angle * angle / 6.0;
  const Quaterniond turn(std::cos(angle), share * half.x(), share * half.y(), share * half.z());
  return (turn * q_WB).normalized();
}

}  // namespace

ChainDynamics::ChainDynamics(const Mechanism& mechanism, const SolverSettings& settings)
    : Dynamics(mechanism, settings),
      models_(mechanism.joints),
      half_length_m_(mechanism.half_length_m),
      radius_m_(mechanism.radius_m),
      gravity_m_s2_(mechanism.gravity_m_s2),
      system_(mechanism.modules.size()),
      drifts_(mechanism.modules.size()) {
  for (const auto* bodies : {&mechanism.modules, &mechanism.objects}) {
    for (const RigidBody& body : *bodies) {
      BodyMotion& state = bodies_[inertial_.size()];
      state.position_m = body.X_WB.translation();
      state.q_WB = Quaterniond(body.X_WB.linear()).normalized();
      state.R_WB = state.q_WB.toRotationMatrix();
      inertial_.push_back({body.mass_kg, body.inertia_kg_m2});
    }
  }
  system_.bodies().resize(bodies_.size());
  place_modules();
}

Vector3d ChainDynamics::axis(std::size_t joint) const {
  return bodies_[joint].R_WB.col(models_[joint].axis == JointAxis::kYaw ? 2 : 1);
}

const Vector3d& ChainDynamics::reference(std::size_t body) const {
  return bodies_[body < module_count() ? 0 : body].position_m;
}

Matrix3d ChainDynamics::inertia_W(std::size_t body) const {
  const Matrix3d& R = bodies_[body].R_WB;
  return R * inertial_[body].inertia_kg_m2.asDiagonal() * R.transpose();
}

// The angle of a joint is that of the module ahead relative to the module behind, so a positive one turns what is
// behind backwards.
void ChainDynamics::place_modules() {
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const BodyMotion& ahead = bodies_[i];
    BodyMotion& behind = bodies_[i + 1];
    const double c = std::cos(angles_rad_[i]);
    const double s = std::sin(angles_rad_[i]);
    Matrix3d R_AheadBehind;
    if (models_[i].axis == JointAxis::kYaw) {
      R_AheadBehind << c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0;
    } else {
      R_AheadBehind << c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c;
    }
    behind.R_WB = ahead.R_WB * R_AheadBehind;
    const Vector3d p_WJ = ahead.position_m - half_length_m_ * ahead.R_WB.col(0);
    behind.position_m = p_WJ - half_length_m_ * behind.R_WB.col(0);
    behind.q_WB = Quaterniond(behind.R_WB);
  }
}

void ChainDynamics::move_modules() {
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const BodyMotion& ahead = bodies_[i];
    BodyMotion& behind = bodies_[i + 1];
    const Vector3d p_WJ = ahead.position_m - half_length_m_ * ahead.R_WB.col(0);
    behind.angular_velocity_rad_s = ahead.angular_velocity_rad_s - rates_rad_s_[i] * axis(i);
    behind.velocity_m_s = ahead.velocity_at(p_WJ) + behind.angular_velocity_rad_s.cross(behind.position_m - p_WJ);
  }
}

void ChainDynamics::solve(std::span<const SolverContact> contacts) {
  // All modules are one body here, with the number 0. The smallest number of a group stands for it.
  groups_.resize(bodies_.size());
  std::iota(groups_.begin(), groups_.end(), std::size_t{0});
  std::fill_n(groups_.begin(), module_count(), std::size_t{0});
  for (const SolverContact& contact : contacts) {
    if (contact.second == kFixed) continue;
    const std::size_t one = groups_[contact.first];
    const std::size_t other = groups_[contact.second];
    if (one != other) std::replace(groups_.begin(), groups_.end(), std::max(one, other), std::min(one, other));
  }
  for (std::size_t leader = 0; leader < bodies_.size(); ++leader) {
    if (groups_[leader] != leader) continue;
    group_objects_.clear();
    group_contacts_.clear();
    for (std::size_t body = module_count(); body < bodies_.size(); ++body)
      if (groups_[body] == leader) group_objects_.push_back(body);
    for (std::size_t i = 0; i < contacts.size(); ++i)
      if (groups_[contacts[i].first] == leader) group_contacts_.push_back(i);
    iterations_ += system_.solve(leader == 0, group_objects_, group_contacts_, settings_.step_s);
    if (!system_.solved()) ++unsolved_;
  }
}

void ChainDynamics::step(std::span<const ServoRow> rows, std::span<const SolverContact> contacts) {
  prepare(rows, contacts);
  solve(contacts);
  finish(contacts);
}

void ChainDynamics::prepare(std::span<const ServoRow> rows, std::span<const SolverContact> contacts) {
  prepare_chain();
  prepare_joints(rows);
  for (std::size_t body = module_count(); body < bodies_.size(); ++body) prepare_object(body);
  prepare_contacts(contacts);
}

void ChainDynamics::finish(std::span<const SolverContact> contacts) {
  const Vector6d wanted = momentum_after(contacts);
  integrate();
  restore_momentum(wanted, contacts);
  std::fill(external_.begin(), external_.end(), External{});
}

Vector6d ChainDynamics::momentum_after(std::span<const SolverContact> contacts) {
  forces_n_.resize(contacts.size());
  Vector6d after = momentum().first;
  for (std::size_t k = 0; k < module_count(); ++k) {
    const Vector3d force_n = external_[k].force_n + inertial_[k].mass_kg * gravity_m_s2_;
    after += settings_.step_s *
             (at_point(bodies_[k].position_m, force_n) + spatial(external_[k].torque_nm, Vector3d::Zero()));
  }
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ChainSystem::Contact& contact = system_.contacts()[i];
    forces_n_[i] = contact.law.frame() * contact.force_n;
    const Vector6d impulse = settings_.step_s * at_point(contacts[i].touch.position_m, forces_n_[i]);
    if (contact.first < module_count()) after += impulse;
    if (contact.second < module_count()) after -= impulse;  // kFixed is not a module
  }
  return after;
}

std::pair<Vector6d, Matrix6d> ChainDynamics::momentum() const {
  Vector6d sum = Vector6d::Zero();
  Matrix6d inertia = Matrix6d::Zero();
  for (std::size_t k = 0; k < module_count(); ++k) {
    const BodyMotion& body = bodies_[k];
    const Matrix6d own = spatial_inertia(inertial_[k].mass_kg, inertia_W(k), body.position_m);
    const Vector3d& w = body.angular_velocity_rad_s;
    sum += own * spatial(w, body.velocity_m_s - w.cross(body.position_m));
    inertia += own;
  }
  return {sum, inertia};
}

// With the same generalised velocities, the robot has another momentum in the new posture. The equations of motion
// account for it only to the first order of the step, so that a robot in the air would gain momentum from its own
// motion. What is missing is given to all modules alike, except where the ground holds the robot: there it is the
// ground's. (If the robot got it, too, a part that swings would lose its energy.) A contact that presses
// holds along its normal, and in the directions in which friction is below its bound. In all these directions it
// resists with creep_resistance_n_s_m.
void ChainDynamics::restore_momentum(const Vector6d& wanted, std::span<const SolverContact> contacts) {
  auto [found, resistance] = momentum();
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].first >= module_count() || contacts[i].second != kFixed) continue;
    const ChainSystem::Contact& contact = system_.contacts()[i];
    const ContactSlope slope = contact.law.slope(contact.velocity_m_s);
    for (std::size_t k = 0; k < slope.count; ++k) {
      const auto& [axis, yielding] = slope.terms[k];
      const double holding = axis == Vector3d::UnitX() ? settings_.creep_resistance_n_s_m : yielding;
      const Vector6d wrench = at_point(contacts[i].touch.position_m, contact.law.frame() * axis);
      resistance += settings_.step_s * holding * wrench * wrench.transpose();
    }
  }
  const Vector6d twist = resistance.llt().solve(wanted - found);
  bodies_[0].velocity_m_s += velocity_at(twist, bodies_[0].position_m);
  bodies_[0].angular_velocity_rad_s += twist.head<3>();
  move_modules();
}

void ChainDynamics::integrate() {
  const double h = settings_.step_s;
  for (std::size_t i = 0; i < models_.size(); ++i) {
    const ChainSystem::Joint& joint = system_.joints()[i];
    rates_rad_s_[i] = joint.rate_rad_s;
    angles_rad_[i] += h * joint.rate_rad_s;
    torques_nm_[i] = joint.torque_nm(joint.rate_rad_s);
  }
  const auto integrate_body = [&](std::size_t body) {
    BodyMotion& state = bodies_[body];
    state.angular_velocity_rad_s = system_.bodies()[body].velocity.head<3>();
    state.velocity_m_s = system_.bodies()[body].velocity.tail<3>();
    state.position_m += h * state.velocity_m_s;
    state.q_WB = turned(state.q_WB, state.angular_velocity_rad_s, h);
    state.R_WB = state.q_WB.toRotationMatrix();
  };
  integrate_body(0);
  for (std::size_t body = module_count(); body < bodies_.size(); ++body) integrate_body(body);
  place_modules();
  move_modules();
}

void ChainDynamics::move(std::size_t body, const Vector3d& by_m) {
  BodyMotion& state = bodies_.at(body);
  state.position_m += by_m;
  state.velocity_m_s.setZero();
  state.angular_velocity_rad_s.setZero();
}

std::size_t ChainDynamics::memory_size() const {
  const std::size_t free_bodies = 1 + bodies_.size() - module_count();
  return 19 * free_bodies + 3 * models_.size();
}

// The head, the joints and the objects are the whole memory: everything else follows from them.
std::vector<double> ChainDynamics::save() const {
  std::vector<double> memory;
  memory.reserve(memory_size());
  const auto append = [&](const auto& vector) {
    memory.insert(memory.end(), vector.data(), vector.data() + vector.size());
  };
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (body > 0 && body < module_count()) continue;
    append(bodies_[body].position_m);
    append(bodies_[body].q_WB.coeffs());
    append(bodies_[body].velocity_m_s);
    append(bodies_[body].angular_velocity_rad_s);
    append(system_.bodies()[body].change);
  }
  append(angles_rad_);
  append(rates_rad_s_);
  for (const ChainSystem::Joint& joint : system_.joints()) memory.push_back(joint.change_rad_s);
  return memory;
}

void ChainDynamics::load(std::span<const double> memory) {
  check_size(memory.size(), memory_size());
  const double* from = memory.data();
  const auto take = [&](auto&& vector) {
    std::copy_n(from, vector.size(), vector.data());
    from += vector.size();
  };
  for (std::size_t body = 0; body < bodies_.size(); ++body) {
    if (body > 0 && body < module_count()) continue;
    BodyMotion& state = bodies_[body];
    take(state.position_m);
    take(state.q_WB.coeffs());
    take(state.velocity_m_s);
    take(state.angular_velocity_rad_s);
    take(system_.bodies()[body].change);
    state.R_WB = state.q_WB.toRotationMatrix();
  }
  take(angles_rad_);
  take(rates_rad_s_);
  for (ChainSystem::Joint& joint : system_.joints()) joint.change_rad_s = *from++;
  place_modules();
  move_modules();
}

}  // namespace constrictor
