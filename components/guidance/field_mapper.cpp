#include "guidance/field_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "guidance/planar.hpp"

namespace constrictor::guidance {
namespace {

Eigen::Vector2d place_of(const PlanarPose& pose) { return {pose.x_m, pose.y_m}; }

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int32_t kMaxHits = 1000;
constexpr double kDefaultRadius_m = 0.085;
constexpr double kPushed_m = 0.04;             // an object may slide so far, more or less, in a tick of touch
constexpr std::int64_t kTentativeTicks = 150;  // an unconfirmed landmark not seen for so long was none

}  // namespace

FieldMapper::FieldMapper(FieldState& state, PoseFilter& filter, const RobotModel& model, const GuidanceConfig& config)
    : state_(state), filter_(filter), model_(model), config_(config) {}

Eigen::Vector2d FieldMapper::position(const Landmark& landmark) const {
  if (landmark.slot >= 0) return filter_.landmark(static_cast<std::size_t>(landmark.slot));
  return {landmark.x_m, landmark.y_m};
}

double FieldMapper::sd(const Landmark& landmark) const {
  if (landmark.slot < 0) return landmark.sd_m;
  return std::sqrt(0.5 * filter_.landmark_covariance(static_cast<std::size_t>(landmark.slot)).trace());
}

void FieldMapper::release_slot(Landmark& landmark) {
  if (landmark.slot < 0) return;
  const Eigen::Vector2d p = position(landmark);
  landmark.sd_m = sd(landmark);
  landmark.x_m = p.x();
  landmark.y_m = p.y();
  filter_.remove(static_cast<std::size_t>(landmark.slot));
  for (Landmark& other : state_.landmarks) {
    if (other.slot > landmark.slot) --other.slot;
  }
  landmark.slot = -1;
}

void FieldMapper::forget(std::size_t index) {
  release_slot(state_.landmarks[index]);
  state_.landmarks.erase(state_.landmarks.begin() + static_cast<std::ptrdiff_t>(index));
}

void FieldMapper::create(const msg::Blob& blob, const Eigen::Vector2d& z, const Eigen::Matrix2d& noise,
                         std::int64_t tick) {
  if (state_.landmarks.size() >= static_cast<std::size_t>(msg::kMaxMapObjects)) return;
  Landmark landmark;
  landmark.handle = state_.next_handle++;
  landmark.colour = blob.colour;
  landmark.kind = blob.kind;
  landmark.slot = static_cast<std::int32_t>(filter_.landmark_count());
  landmark.hits = 1;
  landmark.last_seen_tick = tick;
  filter_.add(z, noise);
  state_.landmarks.push_back(landmark);
}

void FieldMapper::place(const msg::Blob& blob, const Pose2& exposure, std::int64_t tick, std::vector<bool>& used) {
  const bool whole = !blob.cut_left && !blob.cut_right;
  const double radius_m = std::isfinite(blob.width_m) && whole ? 0.5 * blob.width_m : kDefaultRadius_m;
  const double distance_m = blob.range_m + radius_m;
  const Eigen::Vector2d sight = along(blob.bearing_rad), across = left(blob.bearing_rad);
  const Eigen::Vector2d z = to_parent(exposure, distance_m * sight);
  // a thing that the image cuts has its centre somewhere else
  const double range_sd = config_.range_sd_m + config_.range_sd_1_m * distance_m * distance_m;
  const double across_sd = config_.bearing_sd_rad * distance_m + 0.01 + (whole ? 0.0 : radius_m);
  Eigen::Matrix2d noise = range_sd * range_sd * sight * sight.transpose() + across_sd * across_sd * across * across.transpose();
  noise *= config_.inflation;

  std::size_t best = state_.landmarks.size(), nearest = best;
  double best_distance2 = config_.gate, nearest_m = config_.merge_m;
  const Eigen::Vector2d p_M = to_parent(filter_.pose(), z);
  for (std::size_t i = 0; i < state_.landmarks.size(); ++i) {
    const Landmark& landmark = state_.landmarks[i];
    if (landmark.colour != blob.colour || landmark.kind != blob.kind) continue;
    const double apart_m = (position(landmark) - p_M).norm();
    if (landmark.carried) {
      if (apart_m < 0.3) return;  // what the body holds is no landmark
      continue;
    }
    if (used[i] || landmark.slot < 0) continue;
    const double d2 = filter_.distance2(static_cast<std::size_t>(landmark.slot), z, noise);
    if (d2 < best_distance2) {
      best = i;
      best_distance2 = d2;
    }
    if (apart_m < nearest_m) {
      nearest = i;
      nearest_m = apart_m;
    }
  }

  if (best == state_.landmarks.size() && nearest < state_.landmarks.size()) {
    Landmark& moved = state_.landmarks[nearest];
    used[nearest] = true;
    if (!whole || ++moved.strays < config_.confirm) return;
    // it was pushed: place it afresh under the same handle
    release_slot(moved);
    moved.slot = static_cast<std::int32_t>(filter_.landmark_count());
    filter_.add(z, noise);
    moved.strays = 0;
    moved.last_seen_tick = tick;
    return;
  }
  if (best == state_.landmarks.size()) {
    if (!whole) return;
    create(blob, z, noise, tick);
    used.resize(state_.landmarks.size(), true);
    return;
  }
  used[best] = true;
  Landmark& landmark = state_.landmarks[best];
  filter_.observe(static_cast<std::size_t>(landmark.slot), z, noise);
  landmark.hits = std::min(landmark.hits + 1, kMaxHits);
  landmark.strays = 0;
  landmark.last_seen_tick = tick;
  if (whole && !blob.cut_bottom && std::isfinite(blob.width_m)) {
    const double share = landmark.radius_m > 0.0 ? 1.0 / std::min(landmark.hits, 50) : 1.0;
    landmark.radius_m += share * (0.5 * blob.width_m - landmark.radius_m);
  }
}

void FieldMapper::glimpse(const msg::Blob& blob, const Pose2& exposure, std::int64_t tick) {
  // too near for a range: the landmark of that colour close by in that direction
  for (Landmark& landmark : state_.landmarks) {
    if (landmark.colour != blob.colour || landmark.kind != blob.kind || landmark.carried) continue;
    const Eigen::Vector2d p = from_parent(exposure, from_parent(filter_.pose(), position(landmark)));
    const double bearing = std::atan2(p.y(), p.x());
    if (p.norm() < 0.7 && std::abs(wrapped(bearing - blob.bearing_rad)) < 0.5) landmark.last_seen_tick = tick;
  }
}

void FieldMapper::objects(const msg::ObjectPercepts& percepts, const Pose2& exposure, std::int64_t tick) {
  std::vector<bool> used(state_.landmarks.size(), false);
  const int count = std::min<int>(percepts.blob_count, msg::kMaxBlobs);
  for (int i = 0; i < count; ++i) {
    const msg::Blob& blob = percepts.blobs[i];
    if (blob.kind == msg::kBlobUndecided || !std::isfinite(blob.bearing_rad)) continue;
    if (!std::isfinite(blob.range_m)) {
      glimpse(blob, exposure, tick);
    } else if (blob.range_m < config_.max_range_m) {
      place(blob, exposure, tick, used);
    }
  }
  for (std::size_t i = state_.landmarks.size(); i-- > 0;) {
    const Landmark& landmark = state_.landmarks[i];
    if (landmark.hits < config_.confirm && tick - landmark.last_seen_tick > kTentativeTicks) forget(i);
  }
}

void FieldMapper::line(const msg::LinePercept& percept, const Pose2& exposure, std::int64_t tick, double period_s) {
  if (!percept.visible) return;
  if (percept.colour != state_.line_colour) {
    state_.line_colour = percept.colour;
    state_.line_x_m.clear();
    state_.line_y_m.clear();
    state_.line_tick.clear();
  }
  const auto old_ticks = static_cast<std::int64_t>(std::llround(config_.line_correct_after_s / period_s));
  const int count = std::min<int>(percept.point_count, msg::kMaxPerceptPoints);
  const int stride = std::max(1, count / 4);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p_G(percept.x_m[i], percept.y_m[i]);
    if (!p_G.allFinite() || p_G.norm() > config_.line_map_range_m) continue;
    const Eigen::Vector2d z = to_parent(exposure, p_G);
    const Eigen::Vector2d p = to_parent(filter_.pose(), z);

    // the piece of the known line around it
    const double reach_m = std::max(3.0 * config_.line_spacing_m, config_.line_correct_gate_m);
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
    double nearest_m = 1e9;
    int near = 0;
    bool old = true;
    for (std::size_t k = 0; k < state_.line_x_m.size(); ++k) {
      const Eigen::Vector2d q(state_.line_x_m[k], state_.line_y_m[k]);
      const double apart_m = (q - p).norm();
      nearest_m = std::min(nearest_m, apart_m);
      if (apart_m > reach_m) continue;
      centre += q;
      ++near;
      old = old && tick - state_.line_tick[k] > old_ticks;
    }
    if (near >= 3 && old && i % stride == 0) {
      centre /= near;
      Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
      for (std::size_t k = 0; k < state_.line_x_m.size(); ++k) {
        const Eigen::Vector2d q(state_.line_x_m[k], state_.line_y_m[k]);
        if ((q - p).norm() <= reach_m) scatter += (q - centre) * (q - centre).transpose();
      }
      const double angle = 0.5 * std::atan2(2.0 * scatter(0, 1), scatter(0, 0) - scatter(1, 1));
      const Eigen::Vector2d normal = left(angle);
      const double residual_m = normal.dot(p - centre);
      if (std::abs(residual_m) < config_.line_correct_gate_m) {
        const double sd_m = config_.line_correct_sd_m + 0.03 * p_G.norm();
        filter_.observe_line(residual_m, normal, p - filter_.pose().position(), config_.inflation * sd_m * sd_m);
      }
    }
    if (nearest_m > config_.line_spacing_m && state_.line_x_m.size() < static_cast<std::size_t>(msg::kMaxMapLinePoints)) {
      state_.line_x_m.push_back(p.x());
      state_.line_y_m.push_back(p.y());
      state_.line_tick.push_back(tick);
    }
  }
}

bool FieldMapper::is_self(const BodyChain& chain, std::size_t module, const Eigen::Vector2d& p) const {
  const double half_m = 0.5 * model_.module_length_m;
  for (std::size_t j = 0; j < chain.size(); ++j) {
    if ((j > module ? j - module : module - j) < 3) continue;
    const Eigen::Vector2d d = p - place_of(chain[j]), axis = along(chain[j].yaw_rad);
    const double s = std::clamp(d.dot(axis), -half_m, half_m);
    if ((d - s * axis).norm() < model_.module_radius_m + config_.touch_self_margin_m) return true;
  }
  return false;
}

void FieldMapper::touch(const msg::ContactState& contacts, const BodyChain& chain, std::int64_t tick, double period_s) {
  const auto keep = static_cast<std::int64_t>(std::llround(config_.touch_keep_s / period_s));
  while (!state_.felt.empty() && tick - state_.felt.front().tick > keep) state_.felt.pop_front();

  const int count = std::min<int>(contacts.contact_count, msg::kMaxContacts);
  for (int i = 0; i < count; ++i) {
    const msg::Contact& contact = contacts.contacts[i];
    const std::size_t module = contact.module_index;
    if (module >= chain.size() || !(std::abs(contact.normal.z) < config_.touch_max_normal_z)) continue;
    const Eigen::Vector3d force(contact.force_n.x, contact.force_n.y, contact.force_n.z);
    const double force_n = force.norm();
    if (!(force_n > config_.touch_min_force_n)) continue;
    const Eigen::Vector2d p = transform(chain[module], {contact.position_m.x, contact.position_m.y});
    if (is_self(chain, module, p)) continue;
    const Eigen::Vector2d p_M = to_parent(filter_.pose(), p);

    // a contact that lasts is one entry
    const auto same = std::find_if(state_.felt.begin(), state_.felt.end(), [&](const Felt& felt) {
      return felt.module_index == module && std::hypot(felt.x_m - p_M.x(), felt.y_m - p_M.y()) < 0.04;
    });
    if (same != state_.felt.end()) state_.felt.erase(same);
    state_.felt.push_back({p_M.x(), p_M.y(), force_n, contact.module_index, tick});
    if (state_.felt.size() > static_cast<std::size_t>(msg::kMaxFelt)) state_.felt.pop_front();

    Landmark* nearest = nullptr;
    double nearest_m = 1e9;
    for (Landmark& landmark : state_.landmarks) {
      if (landmark.kind != msg::kBlobObject || landmark.hits < config_.confirm) continue;
      const double radius_m = landmark.radius_m > 0.0 ? landmark.radius_m : kDefaultRadius_m;
      const double off_m = std::abs((position(landmark) - p_M).norm() - radius_m);
      if (off_m < 0.08 + 2.0 * sd(landmark) && off_m < nearest_m) {
        nearest = &landmark;
        nearest_m = off_m;
      }
    }
    if (nearest == nullptr) continue;
    nearest->felt = true;
    // what is pushed slides: from now on its percepts shall move it, not the pose
    if (nearest->slot >= 0) filter_.loosen(static_cast<std::size_t>(nearest->slot), kPushed_m * kPushed_m);
  }
}

Eigen::Vector2d FieldMapper::base_of_u(const BodyChain& chain, double radius_m) const {
  // the middle of the three neighbouring yaw links that turn most
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
  return place_of(middle) + side * (radius_m + model_.module_radius_m) * left(middle.yaw_rad);
}

void FieldMapper::carry(const msg::TaskStatus& task, const BodyChain& chain, std::int64_t tick) {
  const auto held = std::find_if(state_.landmarks.begin(), state_.landmarks.end(), [](const Landmark& l) { return l.carried; });
  if (task.carrying && !state_.carrying && held == state_.landmarks.end()) {
    // which one: the task's own object, else the nearest of its colour, else the nearest
    const Eigen::Vector2d base = to_parent(filter_.pose(), base_of_u(chain, kDefaultRadius_m));
    Landmark* best = nullptr;
    double best_m = 1e9;
    for (Landmark& landmark : state_.landmarks) {
      if (landmark.kind != msg::kBlobObject) continue;
      double apart_m = (position(landmark) - base).norm();
      if (task.parameters.object_handle != 0 && landmark.handle == task.parameters.object_handle) apart_m = -1.0;
      if (task.parameters.object_colour != msg::kColourUnknown && landmark.colour != task.parameters.object_colour) continue;
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
    const double radius_m = landmark.radius_m > 0.0 ? landmark.radius_m : kDefaultRadius_m;
    const Eigen::Vector2d base = base_of_u(chain, radius_m);
    if (task.carrying) {
      const Eigen::Vector2d p_M = to_parent(filter_.pose(), base);
      landmark.x_m = p_M.x();
      landmark.y_m = p_M.y();
      landmark.sd_m = 0.05;
    } else {
      // let go: from now on it stays where the base was
      landmark.carried = false;
      landmark.slot = static_cast<std::int32_t>(filter_.landmark_count());
      filter_.add(base, 0.06 * 0.06 * Eigen::Matrix2d::Identity());
      landmark.last_seen_tick = tick;
    }
  }
}

void FieldMapper::fill(msg::FieldMap& map) const {
  map.line_colour = state_.line_colour;
  const std::size_t points = std::min<std::size_t>(state_.line_x_m.size(), static_cast<std::size_t>(msg::kMaxMapLinePoints));
  map.line_point_count = static_cast<std::uint16_t>(points);
  std::copy_n(state_.line_x_m.begin(), points, map.line_x_m);
  std::copy_n(state_.line_y_m.begin(), points, map.line_y_m);
  map.object_count = 0;
  for (const Landmark& landmark : state_.landmarks) {
    if (landmark.hits < config_.confirm && !landmark.carried) continue;
    msg::MapObject& out = map.objects[map.object_count++];
    const Eigen::Vector2d p = position(landmark);
    out.handle = landmark.handle;
    out.colour = landmark.colour;
    out.kind = landmark.kind;
    out.x_m = p.x();
    out.y_m = p.y();
    out.radius_m = landmark.radius_m > 0.0 ? landmark.radius_m : kNan;
    out.sd_m = sd(landmark);
    out.felt = landmark.felt;
    out.carried = landmark.carried;
    out.last_seen_tick = landmark.last_seen_tick;
  }
  map.felt_count = static_cast<std::uint16_t>(state_.felt.size());
  for (std::size_t i = 0; i < state_.felt.size(); ++i) {
    const Felt& felt = state_.felt[i];
    map.felt[i] = {felt.x_m, felt.y_m, felt.force_n, felt.module_index, felt.tick};
  }
}

}  // namespace constrictor::guidance
