// The part of ChainSystem that makes the matrix of an iteration of Newton's method, and solves with it.
#include <algorithm>

#include "sim/world/chain_system.hpp"

namespace constrictor {

using Eigen::Index;

void ChainSystem::assemble() {
  for (const std::size_t b : members_) stiffness_[b] = bodies_[b].inertia;
  for (const std::size_t index : active_) {
    const Contact& contact = contacts_[index];
    if (is_self(contact)) continue;
    const ContactSlope slope = contact.law.slope(contact.velocity_m_s);
    for (std::size_t i = 0; i < slope.count; ++i) {
      const double weight = step_s_ * slope.terms[i].slope;
      const Vector6d first = contact.on_first * slope.terms[i].axis;
      stiffness_[contact.first].noalias() += (weight * first) * first.transpose();
      if (contact.second == kFixed) continue;
      const Vector6d second = contact.on_second * slope.terms[i].axis;
      stiffness_[contact.second].noalias() += (weight * second) * second.transpose();
    }
  }
  // The recursion over the chain does not overwrite the objects' part, so the objects can come first.
  assemble_objects();
  if (!with_chain_) return;
  if (!folded_) {
    for (std::size_t j = 0; j < joints_.size(); ++j)
      hinges_[j] = {joints_[j].axis, step_s_ * joints_[j].slope(joints_[j].rate_rad_s)};
    chain_factor_.compute(std::span(stiffness_).first(modules_), hinges_);
    return;
  }
  assemble_chain();
  for (const std::size_t index : active_)
    if (is_self(contacts_[index])) add_self_contact(contacts_[index]);
}

// The composite-rigid-body algorithm. Only the lower triangle is needed.
void ChainSystem::assemble_chain() {
  for (std::size_t k = modules_ - 1; k > 0; --k) {
    const Index row = static_cast<Index>(5 + k);
    const Joint& joint = joints_[k - 1];
    const Vector6d momentum = stiffness_[k] * joint.axis;
    now_->hessian(row, row) = joint.axis.dot(momentum) + step_s_ * joint.slope(joint.rate_rad_s);
    for (std::size_t j = k - 1; j > 0; --j)
      now_->hessian(row, static_cast<Index>(5 + j)) = joints_[j - 1].axis.dot(momentum);
    now_->hessian.row(row).head<6>() = momentum.transpose();
    stiffness_[k - 1] += stiffness_[k];
  }
  now_->hessian.topLeftCorner<6, 6>() = stiffness_[0];
}

// The rows of the objects: with themselves, with objects before them, and with the chain.
void ChainSystem::assemble_objects() {
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    const Index row = offsets_[objects_[o]];
    now_->hessian.middleRows<6>(row).leftCols(row).setZero();
    now_->hessian.block<6, 6>(row, row) = stiffness_[objects_[o]];
  }
  for (const std::size_t object : objects_) {
    const Index row = offsets_[object];
    bool touched = false;
    for (const std::size_t index : active_) {
      const Contact& contact = contacts_[index];
      if (contact.second == kFixed || (contact.first != object && contact.second != object)) continue;
      const std::size_t other = contact.first == object ? contact.second : contact.first;
      const bool above = is_module(other) || offsets_[other] < row;
      if (!above) continue;
      const auto& on_object = contact.first == object ? contact.on_first : contact.on_second;
      const auto& on_other = contact.first == object ? contact.on_second : contact.on_first;
      if (is_module(other) && !touched) {
        touched = true;
        std::fill(coupling_.begin(), coupling_.end(), Matrix6d::Zero());
      }
      const ContactSlope slope = contact.law.slope(contact.velocity_m_s);
      for (std::size_t i = 0; i < slope.count; ++i) {
        const Vector6d mine = (-step_s_ * slope.terms[i].slope) * (on_object * slope.terms[i].axis);
        const Vector6d others = on_other * slope.terms[i].axis;
        if (is_module(other)) {
          coupling_[other].noalias() += mine * others.transpose();
        } else {
          now_->hessian.block<6, 6>(row, offsets_[other]).noalias() += mine * others.transpose();
        }
      }
    }
    if (!touched) continue;
    for (std::size_t k = modules_ - 1; k > 0; --k) {
      now_->hessian.block<6, 1>(row, static_cast<Index>(5 + k)).noalias() = coupling_[k] * joints_[k - 1].axis;
      coupling_[k - 1] += coupling_[k];
    }
    now_->hessian.block<6, 6>(row, 0) = coupling_[0];
  }
}

// A contact between two modules depends only on the joints between them.
void ChainSystem::add_self_contact(const Contact& contact) {
  const std::size_t front = std::min(contact.first, contact.second);
  const std::size_t back = std::max(contact.first, contact.second);
  const auto& on_back = contact.first == back ? contact.on_first : contact.on_second;
  const ContactSlope slope = contact.law.slope(contact.velocity_m_s);
  const auto count = static_cast<Index>(back - front);
  const auto at = static_cast<Index>(6 + front);  // row of the joint behind the module `front`
  for (std::size_t i = 0; i < slope.count; ++i) {
    const Vector6d wrench = on_back * slope.terms[i].axis;
    for (Index j = 0; j < count; ++j) now_->step[j] = joints_[front + static_cast<std::size_t>(j)].axis.dot(wrench);
    now_->hessian.block(at, at, count, count).noalias() +=
        (step_s_ * slope.terms[i].slope) * now_->step.head(count) * now_->step.head(count).transpose();
  }
}

void ChainSystem::find_step() {
  now_->step = -now_->gradient;
  if (!with_chain_ || folded_) {
    now_->factor.compute(now_->hessian);
    now_->factor.solveInPlace(now_->step);
    return;
  }
  const Index chain = static_cast<Index>(6 + joints_.size());
  const Index objects = size_ - chain;
  chain_factor_.solve(now_->step.head(chain));
  if (objects == 0) return;
  // The chain is eliminated from the equations of the objects (Schur complement).
  const auto coupling = now_->hessian.bottomLeftCorner(objects, chain);
  auto remaining = now_->hessian.bottomRightCorner(objects, objects);
  now_->response = coupling;
  for (Index row = 0; row < objects; row += 6) chain_factor_.solve_six(now_->response.middleRows<6>(row));
  remaining.triangularView<Eigen::Lower>() -= now_->response * coupling.transpose();
  now_->step.tail(objects).noalias() -= coupling * now_->step.head(chain);
  now_->factor.compute(remaining);
  now_->step.tail(objects) = now_->factor.solve(now_->step.tail(objects));
  now_->step.head(chain).noalias() -= now_->response.transpose() * now_->step.tail(objects);
}

}  // namespace constrictor
