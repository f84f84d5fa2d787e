#include "sim/world/contact_set.hpp"

#include <algorithm>

#include "sim/world/ode_eigen.hpp"

namespace constrictor {
namespace {

using Eigen::Vector3d;

// Number of felt contacts that are recorded in a step. Further contacts are simulated but not felt. 64 modules stay far
// below this number.
constexpr std::size_t kMostFelt = 1024;

std::uint32_t key_of(std::uint8_t module, Touched touched, std::uint8_t index, std::uint8_t feature) {
  return (std::uint32_t{module} << 24) | (static_cast<std::uint32_t>(touched) << 16) | (std::uint32_t{index} << 8) |
         feature;
}

void copy(const Vector3d& from, dVector3 to) {
  to[0] = from.x();
  to[1] = from.y();
  to[2] = from.z();
  to[3] = 0.0;
}

/// R_WB^T v: a vector of W in the frame of the body.
Vector3d to_body(dBodyID body, const Vector3d& v) {
  const dReal* R = dBodyGetRotation(body);
  return {R[0] * v.x() + R[4] * v.y() + R[8] * v.z(), R[1] * v.x() + R[5] * v.y() + R[9] * v.z(),
          R[2] * v.x() + R[6] * v.y() + R[10] * v.z()};
}

/// Velocity in W of the point `p` of a body.
Vector3d velocity_at(dBodyID body, const Vector3d& p) {
  return vector_of(dBodyGetLinearVel(body)) +
         vector_of(dBodyGetAngularVel(body)).cross(p - vector_of(dBodyGetPosition(body)));
}

/// The same at the end of the step, if nothing but the external forces acts on the body. A null body is at rest.
Vector3d free_velocity(dBodyID body, const Vector3d& p, double step_s) {
  if (body == nullptr) return Vector3d::Zero();
  dMass mass;
  dBodyGetMass(body, &mass);
  return velocity_at(body, p) + step_s / mass.mass * vector_of(dBodyGetForce(body));
}

}  // namespace

ContactSet::ContactSet(dWorldID world, const SolverSettings& settings)
    : world_(world), step_s_(settings.step_s), group_(dJointGroupCreate(0)) {
  surface_.mode = dContactApprox1 | dContactSoftERP | dContactSoftCFM;
  // ODE's softness of a spring and a damper in parallel. Unlike fixed numbers, it gives the same contact at each step.
  const double spring = settings.step_s * settings.contact_stiffness_n_m;
  surface_.soft_erp = spring / (spring + settings.contact_damping_n_s_m);
  surface_.soft_cfm = 1.0 / (spring + settings.contact_damping_n_s_m);
  feedback_.resize(kMostFelt);
  records_.reserve(kMostFelt);
  sums_.reserve(kMostFelt);
}

void ContactSet::begin_tick() {
  sums_.clear();
  steps_ = 0;
}

void ContactSet::begin_step() {
  dJointGroupEmpty(group_.get());
  records_.clear();
}

// ODE bounds each of two friction forces separately, so that the bound on their sum is a square: up to sqrt 2 times the
// friction along its diagonals. With one of the two forces along the direction of sliding, the sum is right in each
// direction.
Vector3d ContactSet::sliding_direction(const TouchPoint& touch, dBodyID first, dBodyID second) const {
  constexpr double kStill_m_s = 1e-9;
  const Vector3d& p = touch.position_m;
  Vector3d sliding = free_velocity(first, p, step_s_) - free_velocity(second, p, step_s_);
  sliding -= touch.normal.dot(sliding) * touch.normal;
  if (sliding.norm() < kStill_m_s) sliding = touch.normal.unitOrthogonal();
  return sliding.normalized();
}

dJointID ContactSet::make(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second) {
  dContact contact{};
  contact.surface = surface_;
  contact.surface.mu = friction.along;
  contact.surface.mode |= dContactFDir1;
  if (friction.direction != nullptr) {
    contact.surface.mode |= dContactMu2;
    contact.surface.mu2 = friction.across;
    copy(*friction.direction, contact.fdir1);
  } else {
    copy(sliding_direction(touch, first, second), contact.fdir1);
  }
  copy(touch.position_m, contact.geom.pos);
  copy(touch.normal, contact.geom.normal);
  contact.geom.depth = touch.depth_m;
  const dJointID joint = dJointCreateContact(world_, group_.get(), &contact);
  dJointAttach(joint, first, second);
  return joint;
}

void ContactSet::add(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second) {
  make(touch, friction, first, second);
}

void ContactSet::add_felt(const TouchPoint& touch, const Friction& friction, dBodyID first, dBodyID second,
                          std::uint8_t module, Touched touched, std::uint8_t index, std::uint8_t feature) {
  const dJointID joint = make(touch, friction, first, second);
  if (records_.size() == kMostFelt) return;
  dJointSetFeedback(joint, &feedback_[records_.size()]);
  records_.push_back({first, second, key_of(module, touched, index, feature), touch});
}

void ContactSet::sum_up(std::uint32_t key, dBodyID body, const Vector3d& position, const Vector3d& normal,
                        const dReal* force) {
  auto at =
      std::lower_bound(sums_.begin(), sums_.end(), key, [](const Sum& sum, std::uint32_t k) { return sum.key < k; });
  if (at == sums_.end() || at->key != key) {
    if (sums_.size() == kMostFelt) return;
    Sum fresh;
    fresh.key = key;
    at = sums_.insert(at, fresh);
  }
  const Vector3d force_in_body = to_body(body, vector_of(force));
  const double weight = force_in_body.norm() + 1e-12;  // a contact without force needs a position, too
  at->force += force_in_body;
  at->position += weight * to_body(body, position - vector_of(dBodyGetPosition(body)));
  at->normal += weight * to_body(body, normal);
  at->weight += weight;
}

void ContactSet::collect() {
  ++steps_;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const Record& record = records_[i];
    const dJointFeedback& feedback = feedback_[i];
    sum_up(record.key, record.first, record.touch.position_m, record.touch.normal, feedback.f1);
    const auto touched = static_cast<Touched>((record.key >> 16) & 0xFFU);
    if (touched != Touched::kSelf) continue;
    // The other module feels the same contact with the opposite normal.
    const auto module = static_cast<std::uint8_t>(record.key >> 24);
    const auto other = static_cast<std::uint8_t>(record.key >> 8);
    sum_up(key_of(other, Touched::kSelf, module, static_cast<std::uint8_t>(record.key)), record.second,
           record.touch.position_m, -record.touch.normal, feedback.f2);
  }
}

double ContactSet::felt_power_w() const {
  double power_w = 0.0;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const Record& record = records_[i];
    power_w += vector_of(feedback_[i].f1).dot(velocity_at(record.first, record.touch.position_m));
    if (record.second != nullptr)
      power_w += vector_of(feedback_[i].f2).dot(velocity_at(record.second, record.touch.position_m));
  }
  return power_w;
}

std::vector<ModuleContact> ContactSet::felt() const {
  std::vector<ModuleContact> contacts;
  contacts.reserve(sums_.size());
  for (const Sum& sum : sums_) {
    ModuleContact contact;
    contact.module_index = static_cast<std::uint8_t>(sum.key >> 24);
    contact.touched = static_cast<Touched>((sum.key >> 16) & 0xFFU);
    contact.touched_index = static_cast<std::uint8_t>(sum.key >> 8);
    contact.position_m = sum.position / sum.weight;
    contact.normal = sum.normal.normalized();
    contact.force_n = sum.force / steps_;
    contacts.push_back(contact);
  }
  std::stable_sort(contacts.begin(), contacts.end(), [](const ModuleContact& a, const ModuleContact& b) {
    return a.force_n.squaredNorm() > b.force_n.squaredNorm();
  });
  return contacts;
}

}  // namespace constrictor
