// The part of FieldMapper that maps touches, and the object that the body holds.
#include <algorithm>
#include <cmath>

#include "guidance/field_mapper.hpp"
#include "robot/landmarks.hpp"

namespace constrictor::guidance {
namespace {

constexpr double kPushed_m = 0.04;  // standard deviation of the distance that a touched object may slide in a tick
constexpr double kBrush_m = 0.01;   // a body without a skin may touch what is nearer than this and its uncertainty
constexpr double kBrushSd_m = 0.1;  // at most: the place of an object that nobody has seen for long is anywhere

}  // namespace

bool FieldMapper::is_self(const BodyChain& chain, std::size_t module, const Eigen::Vector2d& p) const {
  const double half_m = 0.5 * model_.module_length_m;
  for (std::size_t j = 0; j < chain.size(); ++j) {
    if ((j > module ? j - module : module - j) < 3) continue;
    const Eigen::Vector2d d = p - chain[j].p, axis = along(chain[j].yaw_rad);
    const double s = std::clamp(d.dot(axis), -half_m, half_m);
    if ((d - s * axis).norm() < model_.module_radius_m + config_.touch_self_margin_m) return true;
  }
  return false;
}

void FieldMapper::touch(const msg::ContactState& contacts, const BodyChain& chain, std::int64_t tick, double period_s) {
  const auto keep = static_cast<std::int64_t>(std::llround(config_.touch_keep_s / period_s));
  while (!state_.felt.empty() && tick - state_.felt.front().tick > keep) state_.felt.pop_front();
  clear_obstacles(chain);

  const int count = std::min<int>(contacts.contact_count, msg::kMaxContacts);
  for (int i = 0; i < count; ++i) {
    const msg::Contact& contact = contacts.contacts[i];
    const std::size_t module = contact.module_index;
    if (module >= chain.size() || !(std::abs(contact.normal.z) < config_.touch_max_normal_z)) continue;
    const Eigen::Vector3d force(contact.force_n.x, contact.force_n.y, contact.force_n.z);
    const double force_n = force.norm();
    if (!(force_n > config_.touch_min_force_n)) continue;
    const Eigen::Vector2d p = chain[module].to_parent({contact.position_m.x, contact.position_m.y});
    if (is_self(chain, module, p)) continue;
    const Eigen::Vector2d p_M = to_parent(filter_.pose(), p);

    // A contact that lasts several ticks stays one entry.
    const auto same = std::find_if(state_.felt.begin(), state_.felt.end(), [&](const Felt& felt) {
      return felt.module_index == module && std::hypot(felt.x_m - p_M.x(), felt.y_m - p_M.y()) < 0.04;
    });
    if (same != state_.felt.end()) state_.felt.erase(same);
    state_.felt.push_back({p_M.x(), p_M.y(), force_n, contact.module_index, tick, 0});
    if (state_.felt.size() > static_cast<std::size_t>(msg::kMaxTouches)) state_.felt.pop_front();

    Landmark* nearest = nullptr;
    double nearest_m = 1e9;
    for (Landmark& landmark : state_.landmarks) {
      if (landmark.kind != msg::kBlobObject || landmark.hits < config_.confirm) continue;
      const double off_m = surface_gap_m((position(landmark) - p_M).norm(), radius_of(landmark));
      if (off_m < touch_gate_m(sd(landmark)) && off_m < nearest_m) {
        nearest = &landmark;
        nearest_m = off_m;
      }
    }
    if (nearest == nullptr) {
      feel_obstacle(p_M);
      continue;
    }
    state_.felt.back().handle = nearest->handle;
    nearest->felt = true;
    expect_push(*nearest);
  }
}

void FieldMapper::expect_push(Landmark& landmark) {
  landmark.may_have_moved = true;
  if (landmark.slot >= 0) filter_.loosen(static_cast<std::size_t>(landmark.slot), kPushed_m * kPushed_m);
}

bool FieldMapper::brush(const BodyChain& chain) {
  bool any = false;
  for (Landmark& landmark : state_.landmarks) {
    if (landmark.kind != msg::kBlobObject || landmark.carried || landmark.hits < config_.confirm) continue;
    const Eigen::Vector2d p = filter_.pose().to_local(position(landmark));
    const double near_m = radius_of(landmark) + model_.module_radius_m + kBrush_m + std::min(sd(landmark), kBrushSd_m);
    if (!is_near_body(chain, p, near_m)) continue;
    expect_push(landmark);
    any = true;
  }
  return any;
}

Eigen::Vector2d FieldMapper::base_of_u(const BodyChain& chain, double radius_m) const {
  // The base is at the middle of the three neighbouring yaw links that turn most.
  const std::size_t window = std::min<std::size_t>(6, chain.size() - 1);
  std::size_t best = 0;
  double bend = 0.0;
  for (std::size_t i = 0; i + window < chain.size(); ++i) {
    const double turn = chain[i].yaw_rad - chain[i + window].yaw_rad;
    if (std::abs(turn) > std::abs(bend)) {
      bend = turn;
      best = i;
    }
  }
  const PlanarPose& middle = chain[best + window / 2];
  const double side = bend >= 0.0 ? 1.0 : -1.0;
  return middle.p + side * (radius_m + model_.module_radius_m) * left(middle.yaw_rad);
}

void FieldMapper::carry(const msg::TaskStatus& task, const BodyChain& chain, std::int64_t tick) {
  const auto held =
      std::find_if(state_.landmarks.begin(), state_.landmarks.end(), [](const Landmark& l) { return l.carried; });
  if (task.carrying && !state_.carrying && held == state_.landmarks.end()) {
    // The held object is the object that the task names. If the task names none, it is the nearest object of the task's
    // colour, or of any colour if the task has none.
    const Eigen::Vector2d base = to_parent(filter_.pose(), base_of_u(chain, config_.object_radius_m));
    Landmark* best = nullptr;
    double best_m = 1e9;
    for (Landmark& landmark : state_.landmarks) {
      if (landmark.kind != msg::kBlobObject) continue;
      double apart_m = (position(landmark) - base).norm();
      if (task.parameters.object_handle != 0 && landmark.handle == task.parameters.object_handle) apart_m = -1.0;
      if (task.parameters.object_colour != msg::kColourUnknown && landmark.colour != task.parameters.object_colour)
        continue;
      if (apart_m < best_m) {
        best = &landmark;
        best_m = apart_m;
      }
    }
    if (best != nullptr && best_m < 1.0) {
      release_slot(*best);
      best->carried = true;
    }
  }
  state_.carrying = task.carrying;
  for (Landmark& landmark : state_.landmarks) {
    if (!landmark.carried) continue;
    const Eigen::Vector2d base = base_of_u(chain, radius_of(landmark));
    if (task.carrying) {
      const Eigen::Vector2d p_M = to_parent(filter_.pose(), base);
      landmark.x_m = p_M.x();
      landmark.y_m = p_M.y();
      landmark.sd_m = 0.05;
    } else {
      // The body has released the object: the object stays where the base of the U was, or near it, because the arms
      // may push it while they open.
      landmark.carried = false;
      landmark.may_have_moved = true;
      landmark.slot = static_cast<std::int32_t>(filter_.landmark_count());
      filter_.add(base, 0.06 * 0.06 * Eigen::Matrix2d::Identity());
      landmark.last_seen_tick = tick;
    }
  }
}

}  // namespace constrictor::guidance
