#include "sim/world/chain_system.hpp"

#include <algorithm>
#include <cmath>

namespace constrictor {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// [N s, N m s] An iteration ends when no entry of the gradient is larger. In a step of 5 ms it belongs to a force of
/// 0.2 mN.
constexpr double kTolerance = 1e-6;
constexpr int kMostIterations = 50;
/// The line search ends when the derivative has fallen to this share.
constexpr double kFlat = 0.1;

}  // namespace

double ChainSystem::Joint::torque_nm(double rate) const {
  const double held = servo.torque_nm(rate);
  return stop_side == 0.0 ? held
                          : held + stop_side * std::max(0.0, stop_side * (stop.velocity_rad_s - rate) / stop.softness);
}

double ChainSystem::Joint::slope(double rate) const {
  double slope = servo.slope_nm_s_rad(rate);
  if (stop_side * (stop.velocity_rad_s - rate) > 0.0) slope += 1.0 / stop.softness;
  return slope;
}

void ChainSystem::begin(bool with_chain, std::span<const std::size_t> objects) {
  with_chain_ = with_chain;
  objects_ = objects;
  members_.clear();
  for (std::size_t k = 0; with_chain && k < modules_; ++k) members_.push_back(k);
  members_.insert(members_.end(), objects.begin(), objects.end());
  size_ = with_chain ? static_cast<Index>(6 + joints_.size()) : 0;
  offsets_.resize(bodies_.size());
  for (const std::size_t object : objects) {
    offsets_[object] = size_;
    size_ += 6;
  }
  change_.resize(bodies_.size());
  wrench_.resize(bodies_.size());
  stiffness_.resize(bodies_.size());
  coupling_.resize(modules_);
  hinges_.resize(joints_.size());
  relative_.assign(bodies_.size(), Vector6d::Zero());
  now_ = &unknowns_[size_];
  now_->gradient.resize(size_);
  now_->step.resize(size_);
  now_->hessian.resize(size_, size_);
  folded_ = with_chain && std::ranges::any_of(active_, [&](std::size_t index) { return is_self(contacts_[index]); });
  rates_before_rad_s_.clear();
  for (const Joint& joint : joints_) rates_before_rad_s_.push_back(joint.rate_rad_s);
  for (const std::size_t index : active_) {
    Contact& contact = contacts_[index];
    contact.velocity_m_s = contact.drift_m_s + contact.on_first.transpose() * bodies_[contact.first].velocity;
    if (contact.second != kFixed)
      contact.velocity_m_s -= contact.on_second.transpose() * bodies_[contact.second].velocity;
  }
}

double ChainSystem::evaluate() {
  for (const std::size_t b : members_) wrench_[b] = bodies_[b].inertia * relative_[b] - bodies_[b].impulse;
  for (const std::size_t index : active_) {
    Contact& contact = contacts_[index];
    contact.law.bound(contact.velocity_m_s);
    contact.force_n = contact.law.force_n(contact.velocity_m_s);
    const Vector3d impulse = step_s_ * contact.force_n;
    wrench_[contact.first] -= contact.on_first * impulse;
    if (contact.second != kFixed) wrench_[contact.second] += contact.on_second * impulse;
  }
  if (with_chain_) {
    for (std::size_t k = modules_ - 1; k > 0; --k) {
      const Joint& joint = joints_[k - 1];
      now_->gradient[static_cast<Index>(5 + k)] =
          joint.axis.dot(wrench_[k]) - step_s_ * joint.torque_nm(joint.rate_rad_s);
      wrench_[k - 1] += wrench_[k];
    }
    now_->gradient.head<6>() = wrench_[0];
  }
  for (const std::size_t object : objects_) now_->gradient.segment<6>(offsets_[object]) = wrench_[object];
  return now_->gradient.cwiseAbs().maxCoeff();
}

void ChainSystem::spread() {
  if (with_chain_) {
    change_[0] = now_->step.head<6>();
    for (std::size_t k = 1; k < modules_; ++k)
      change_[k] = change_[k - 1] + joints_[k - 1].axis * now_->step[static_cast<Index>(5 + k)];
  }
  for (const std::size_t object : objects_) change_[object] = now_->step.segment<6>(offsets_[object]);
  for (const std::size_t index : active_) {
    Contact& contact = contacts_[index];
    contact.change_m_s = contact.on_first.transpose() * change_[contact.first];
    if (contact.second != kFixed) contact.change_m_s -= contact.on_second.transpose() * change_[contact.second];
  }
  inertia_before_ = 0.0;
  inertia_slope_ = 0.0;
  for (const std::size_t b : members_) {
    const Vector6d momentum = bodies_[b].inertia * change_[b];
    inertia_before_ += momentum.dot(relative_[b]) - change_[b].dot(bodies_[b].impulse);
    inertia_slope_ += momentum.dot(change_[b]);
  }
}

double ChainSystem::derivative(double share) const {
  double work = inertia_before_ + share * inertia_slope_;
  for (const std::size_t index : active_) {
    const Contact& contact = contacts_[index];
    work -= step_s_ * contact.change_m_s.dot(contact.law.force_n(contact.velocity_m_s + share * contact.change_m_s));
  }
  for (std::size_t j = 0; with_chain_ && j < joints_.size(); ++j) {
    const double change = now_->step[static_cast<Index>(6 + j)];
    work -= step_s_ * change * joints_[j].torque_nm(joints_[j].rate_rad_s + share * change);
  }
  return work;
}

// The derivative never falls with the share, because the function is convex.
double ChainSystem::search() const {
  const double flat = kFlat * std::abs(now_->gradient.dot(now_->step));
  double low = 0.0;
  double high = 1.0;
  double at_low = now_->gradient.dot(now_->step);
  double at_high = derivative(high);
  while (at_high < -flat && high < 16.0) {
    low = high;
    at_low = at_high;
    high *= 2.0;
    at_high = derivative(high);
  }
  for (int i = 0; i < 20 && at_high > flat; ++i) {
    // Regula falsi; now and then the middle, so that neither end stays where it is.
    const double share = i % 3 == 2 ? 0.5 * (low + high) : low + (high - low) * at_low / (at_low - at_high);
    const double at_share = derivative(share);
    if (std::abs(at_share) <= flat) return share;
    (at_share < 0.0 ? low : high) = share;
    (at_share < 0.0 ? at_low : at_high) = at_share;
  }
  return high;
}

void ChainSystem::begin_as_before() {
  if (with_chain_) {
    now_->step.head<6>() = bodies_[0].change;
    for (std::size_t j = 0; j < joints_.size(); ++j) now_->step[static_cast<Index>(6 + j)] = joints_[j].change_rad_s;
  }
  for (const std::size_t object : objects_) now_->step.segment<6>(offsets_[object]) = bodies_[object].change;
  spread();
  move(1.0);
}

void ChainSystem::remember_changes() {
  for (const std::size_t b : members_) bodies_[b].change = relative_[b];
  for (std::size_t j = 0; with_chain_ && j < joints_.size(); ++j)
    joints_[j].change_rad_s = joints_[j].rate_rad_s - rates_before_rad_s_[j];
}

void ChainSystem::move(double share) {
  for (const std::size_t b : members_) {
    relative_[b] += share * change_[b];
    bodies_[b].velocity += share * change_[b];
  }
  for (std::size_t j = 0; with_chain_ && j < joints_.size(); ++j)
    joints_[j].rate_rad_s += share * now_->step[static_cast<Index>(6 + j)];
  for (const std::size_t index : active_) contacts_[index].velocity_m_s += share * contacts_[index].change_m_s;
}

int ChainSystem::solve(bool with_chain, std::span<const std::size_t> objects, std::span<const std::size_t> contacts,
                       double step_s) {
  step_s_ = step_s;
  active_ = contacts;
  begin(with_chain, objects);
  begin_as_before();
  int iteration = 0;
  double rest = evaluate();
  while (rest > kTolerance && iteration < kMostIterations) {
    assemble();
    find_step();
    spread();
    move(search());
    rest = evaluate();
    ++iteration;
  }
  solved_ = rest <= kTolerance;
  remember_changes();
  return iteration;
}

}  // namespace constrictor
