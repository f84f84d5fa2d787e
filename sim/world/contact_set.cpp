#include "sim/world/contact_set.hpp"

#include <algorithm>

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

/// R_WB^T v: a vector of W in the frame of the body.
Vector3d to_body(const BodyMotion& body, const Vector3d& v) {
  const Eigen::Matrix3d& R = body.R_WB;
  return {R(0, 0) * v.x() + R(1, 0) * v.y() + R(2, 0) * v.z(), R(0, 1) * v.x() + R(1, 1) * v.y() + R(2, 1) * v.z(),
          R(0, 2) * v.x() + R(1, 2) * v.y() + R(2, 2) * v.z()};
}

}  // namespace

ContactSet::ContactSet() {
  contacts_.reserve(kMostFelt);
  felt_.reserve(kMostFelt);
  sums_.reserve(kMostFelt);
}

void ContactSet::begin_tick() {
  sums_.clear();
  steps_ = 0;
}

void ContactSet::begin_step() {
  contacts_.clear();
  felt_.clear();
}

void ContactSet::add_felt(const SolverContact& contact, Touched touched, std::size_t index, std::size_t feature) {
  add(contact);
  if (felt_.size() == kMostFelt) return;
  felt_.push_back({contacts_.size() - 1, key_of(static_cast<std::uint8_t>(contact.first), touched,
                                                static_cast<std::uint8_t>(index), static_cast<std::uint8_t>(feature))});
}

void ContactSet::sum_up(std::uint32_t key, const BodyMotion& body, const TouchPoint& touch, const Vector3d& normal,
                        const Vector3d& force_n) {
  auto at =
      std::lower_bound(sums_.begin(), sums_.end(), key, [](const Sum& sum, std::uint32_t k) { return sum.key < k; });
  if (at == sums_.end() || at->key != key) {
    if (sums_.size() == kMostFelt) return;
    Sum fresh;
    fresh.key = key;
    at = sums_.insert(at, fresh);
  }
  const Vector3d force_in_body = to_body(body, force_n);
  const double weight = force_in_body.norm() + 1e-12;  // a contact without force needs a position, too
  at->force += force_in_body;
  at->position += weight * to_body(body, touch.position_m - body.position_m);
  at->normal += weight * to_body(body, normal);
  at->weight += weight;
}

void ContactSet::collect(const Dynamics& dynamics) {
  ++steps_;
  for (const auto& [index, key] : felt_) {
    const SolverContact& contact = contacts_[index];
    const Vector3d& force_n = dynamics.contact_force_n(index);
    sum_up(key, dynamics.body(contact.first), contact.touch, contact.touch.normal, force_n);
    const auto touched = static_cast<Touched>((key >> 16) & 0xFFU);
    if (touched != Touched::kSelf) continue;
    // The other module feels the same contact with the opposite normal.
    const auto module = static_cast<std::uint8_t>(key >> 24);
    const auto other = static_cast<std::uint8_t>(key >> 8);
    sum_up(key_of(other, Touched::kSelf, module, static_cast<std::uint8_t>(key)), dynamics.body(contact.second),
           contact.touch, -contact.touch.normal, -force_n);
  }
}

double ContactSet::felt_power_w(const Dynamics& dynamics) const {
  double power_w = 0.0;
  for (const Felt& felt : felt_) {
    const SolverContact& contact = contacts_[felt.contact];
    const Vector3d& force_n = dynamics.contact_force_n(felt.contact);
    const Vector3d& p = contact.touch.position_m;
    power_w += force_n.dot(dynamics.body(contact.first).velocity_at(p));
    if (contact.second != kFixed) power_w -= force_n.dot(dynamics.body(contact.second).velocity_at(p));
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
    // In front of all weaker ones. A stable sort would allocate memory.
    const auto stronger = [](const ModuleContact& a, const ModuleContact& b) {
      return a.force_n.squaredNorm() > b.force_n.squaredNorm();
    };
    contacts.insert(std::upper_bound(contacts.begin(), contacts.end(), contact, stronger), contact);
  }
  return contacts;
}

}  // namespace constrictor
