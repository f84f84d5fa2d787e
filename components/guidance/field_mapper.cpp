#include "guidance/field_mapper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace constrictor::guidance {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int32_t kMaxHits = 1000;
constexpr std::int64_t kTentativeTicks = 150;  // unconfirmed landmarks that are not seen for this long are discarded
constexpr double kNear_m = 0.7;                // an object whose range cannot be seen is nearer than this
constexpr double kCutShare = 0.25;  // of the radius: error of the centre of an object that the image's border cuts
constexpr double kPart = 0.5;       // of its radius: a narrower view shows only a part of a landmark

/// Distance [m] and bearing [rad] of the centre of a round object of which the border of the image cuts one side. The
/// centre of the visible part is not the object's centre, and lies on the same side of it in each image. But the side
/// that is in view touches the line of sight, and the range is the one of the near edge in the middle of the part.
std::pair<double, double> centre_of_cut(const msg::Blob& blob, double radius_m) {
  constexpr int kSteps = 8;
  const double part_m = std::isfinite(blob.width_m) ? 0.5 * blob.width_m : 0.0;
  const double half_rad = std::asin(std::clamp(part_m / (blob.range_m + part_m), 0.0, 1.0));
  const double side = blob.cut_left ? 1.0 : -1.0;  // of the hidden part
  const double seen_rad = blob.bearing_rad - side * half_rad;
  double distance_m = blob.range_m + radius_m, bearing_rad = blob.bearing_rad;
  for (int i = 0; i < kSteps; ++i) {
    bearing_rad = seen_rad + side * std::asin(std::min(radius_m / distance_m, 1.0));
    const double aside_rad = wrap_angle_by_shift(bearing_rad - blob.bearing_rad);
    const double aside_m = distance_m * std::sin(aside_rad);
    const double depth_m = std::sqrt(std::max(0.0, radius_m * radius_m - aside_m * aside_m));
    distance_m = (blob.range_m + depth_m) / std::max(0.5, std::cos(aside_rad));
  }
  return {distance_m, bearing_rad};
}

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

bool FieldMapper::full() const { return state_.landmarks.size() >= static_cast<std::size_t>(msg::kMaxMapObjects); }

bool FieldMapper::make_room(std::int64_t tick, std::vector<bool>& used) {
  if (!full()) return true;
  const Landmark* weakest = nullptr;
  for (const Landmark& landmark : state_.landmarks) {
    if (!may_give_way(landmark) || landmark.last_seen_tick >= tick) continue;
    const auto rank = [](const Landmark& one) { return std::pair(one.last_seen_tick, one.hits); };
    if (weakest == nullptr || rank(landmark) < rank(*weakest)) weakest = &landmark;
  }
  if (weakest == nullptr) return false;
  const auto index = weakest - state_.landmarks.data();
  forget(static_cast<std::size_t>(index));
  used.erase(used.begin() + index);
  return true;
}

void FieldMapper::create(const msg::Blob& blob, const Eigen::Vector2d& z, const Eigen::Matrix2d& noise,
                         std::int64_t tick, std::vector<bool>& used) {
  Landmark landmark;
  landmark.colour = blob.colour;
  landmark.kind = blob.kind;
  if (!make_room(tick, used)) {
    const Eigen::Vector2d p_M = to_parent(filter_.pose(), z);
    landmark.x_m = p_M.x();
    landmark.y_m = p_M.y();
    const auto may_go = [this](const Landmark& other) { return may_give_way(other); };
    if (!left_out_ && std::none_of(state_.landmarks.begin(), state_.landmarks.end(), may_go)) left_out_ = landmark;
    return;
  }
  landmark.handle = state_.next_handle++;
  landmark.slot = static_cast<std::int32_t>(filter_.landmark_count());
  landmark.hits = 1;
  landmark.last_seen_tick = tick;
  landmark.object_log_odds = log_odds_of(blob.object_probability);
  filter_.add(z, noise);
  state_.landmarks.push_back(landmark);
  used.push_back(true);
}

double FieldMapper::known_radius_m(const msg::Blob& blob, const Eigen::Vector2d& z) const {
  const Eigen::Vector2d p_M = to_parent(filter_.pose(), z);
  double radius_m = usual_radius_m(blob.kind), nearest_m = config_.merge_m;
  for (const Landmark& landmark : state_.landmarks) {
    if (landmark.colour != blob.colour || landmark.kind != blob.kind || !(landmark.radius_m > 0.0)) continue;
    const double apart_m = (position(landmark) - p_M).norm();
    if (apart_m >= nearest_m) continue;
    nearest_m = apart_m;
    radius_m = landmark.radius_m;
  }
  return radius_m;
}

void FieldMapper::place(const msg::Blob& blob, const PlanarPose& view, double turn_rad, std::int64_t tick,
                        std::vector<bool>& used) {
  const bool whole = !blob.cut_left && !blob.cut_right;
  double radius_m = std::isfinite(blob.width_m) && whole ? 0.5 * blob.width_m : usual_radius_m(blob.kind);
  double distance_m = blob.range_m + radius_m, bearing_rad = blob.bearing_rad;
  if (!whole) {
    radius_m = known_radius_m(blob, to_parent(view, distance_m * along(bearing_rad)));
    std::tie(distance_m, bearing_rad) = centre_of_cut(blob, radius_m);
  }
  const Eigen::Vector2d sight = along(bearing_rad + turn_rad), across = left(bearing_rad + turn_rad);
  const Eigen::Vector2d z = to_parent(view, distance_m * along(bearing_rad));
  const double cut_sd = whole ? 0.0 : kCutShare * radius_m;
  const double range_sd = config_.range_sd_m + config_.range_sd_1_m * distance_m * distance_m + cut_sd;
  const double across_sd = config_.bearing_sd_rad * distance_m + 0.01 + cut_sd;
  Eigen::Matrix2d noise =
      range_sd * range_sd * sight * sight.transpose() + across_sd * across_sd * across * across.transpose();
  noise *= config_.inflation;

  std::size_t best = state_.landmarks.size(), nearest = best;
  double best_cost = std::numeric_limits<double>::infinity(), nearest_m = config_.merge_m;
  const Eigen::Vector2d p_M = to_parent(filter_.pose(), z);
  for (std::size_t i = 0; i < state_.landmarks.size(); ++i) {
    const Landmark& landmark = state_.landmarks[i];
    if (landmark.colour != blob.colour || landmark.kind != blob.kind) continue;
    const double apart_m = (position(landmark) - p_M).norm();
    if (landmark.carried) {
      if (apart_m < 0.3) return;  // this is the object that the body holds: it creates no landmark
      continue;
    }
    if (used[i] || landmark.slot < 0) continue;
    // Of two landmarks in whose gate the percept lies, the likelier one is it: the distance alone would prefer a
    // landmark whose place is uncertain to one that stands exactly there.
    const auto [distance2, log_spread] = filter_.match(static_cast<std::size_t>(landmark.slot), z, noise);
    if (distance2 < config_.gate && distance2 + log_spread < best_cost) {
      best = i;
      best_cost = distance2 + log_spread;
    }
    if (apart_m < nearest_m) {
      nearest = i;
      nearest_m = apart_m;
    }
  }

  // Something hides all but a part of a landmark that looks much narrower than it is: nobody knows where its centre is.
  const auto is_part = [&](const Landmark& landmark) {
    return whole && 0.5 * blob.width_m < kPart * landmark.radius_m;  // false for NaN
  };
  if (best == state_.landmarks.size() && nearest < state_.landmarks.size()) {
    Landmark& moved = state_.landmarks[nearest];
    used[nearest] = true;
    if (!whole || is_part(moved) || (++moved.strays < config_.confirm && !moved.may_have_moved)) return;
    replace(moved, z, noise, tick);  // the object has been pushed, and keeps its handle
    return;
  }
  if (best == state_.landmarks.size()) {
    if (!whole) return;
    create(blob, z, noise, tick, used);
    return;
  }
  used[best] = true;
  Landmark& landmark = state_.landmarks[best];
  if (is_part(landmark)) {
    landmark.last_seen_tick = tick;
    return;
  }
  if (trusted(landmark)) {
    filter_.observe(static_cast<std::size_t>(landmark.slot), z, noise);
  } else {
    replace(landmark, z, noise, tick);  // its place is not known well enough to correct the pose
  }
  landmark.hits = std::min(landmark.hits + 1, kMaxHits);
  landmark.strays = 0;
  learn_kind(blob, tick, landmark);
  landmark.last_seen_tick = tick;
  learn_height(blob, landmark);
  if (whole && !blob.cut_bottom && std::isfinite(blob.width_m)) {
    const double share = landmark.radius_m > 0.0 ? 1.0 / std::min(landmark.hits, 50) : 1.0;
    landmark.radius_m += share * (0.5 * blob.width_m - landmark.radius_m);
  }
}

void FieldMapper::learn_kind(const msg::Blob& blob, std::int64_t tick, Landmark& landmark) {
  constexpr double kLookTicks = 25.0;  // images that follow each other faster have common errors
  constexpr double kMost = 9.0;        // log odds of 0.9999
  const double looks = std::clamp(static_cast<double>(tick - landmark.last_seen_tick) / kLookTicks, 0.0, 1.0);
  landmark.object_log_odds =
      std::clamp(landmark.object_log_odds + looks * log_odds_of(blob.object_probability), -kMost, kMost);
}

void FieldMapper::learn_height(const msg::Blob& blob, Landmark& landmark) {
  constexpr double kShare = 0.1;  // of the newest image in the mean
  if (blob.kind != msg::kBlobObject || blob.cut_bottom || !(blob.height_m > 0.0)) return;
  if (blob.cut_top) landmark.height_m = std::max(landmark.height_m, blob.height_m);
  else landmark.height_m += (landmark.height_m > 0.0 ? kShare : 1.0) * (blob.height_m - landmark.height_m);
}

void FieldMapper::glimpse(const msg::Blob& blob, const PlanarPose& view, std::int64_t tick) {
  // The blob has no range, or its centre is out of view. It belongs to a landmark of its colour that is nearby and in
  // the same direction.
  const double farthest_m = std::isfinite(blob.range_m) ? config_.max_range_m : kNear_m;
  for (Landmark& landmark : state_.landmarks) {
    if (landmark.colour != blob.colour || landmark.kind != blob.kind || landmark.carried) continue;
    const Eigen::Vector2d p = view.to_local(filter_.pose().to_local(position(landmark)));
    const double bearing = std::atan2(p.y(), p.x());
    if (p.norm() < farthest_m && std::abs(wrap_angle_by_shift(bearing - blob.bearing_rad)) < 0.5)
      landmark.last_seen_tick = tick;
  }
}

void FieldMapper::objects(const msg::ObjectPercepts& percepts, const PlanarPose& exposure, std::int64_t tick) {
  const PlanarPose view = view_of(percepts, exposure);
  const double turn_rad = percepts.camera == 0 ? 0.0 : percepts.X_GV.yaw_rad;
  std::vector<bool> used(state_.landmarks.size(), false);
  const int count = std::min<int>(percepts.blob_count, msg::kMaxBlobs);
  for (int i = 0; i < count; ++i) {
    const msg::Blob& blob = percepts.blobs[i];
    if (blob.kind == msg::kBlobUndecided || !std::isfinite(blob.bearing_rad)) continue;
    // The visible part of a zone that the image's border cuts says little of where the zone's centre is.
    const bool part = blob.kind == msg::kBlobZone && (blob.cut_left || blob.cut_right);
    if (!std::isfinite(blob.range_m) || part || (blob.cut_left && blob.cut_right)) {
      glimpse(blob, view, tick);
    } else if (blob.range_m < config_.max_range_m) {
      place(blob, view, turn_rad, tick, used);
    }
  }
  for (std::size_t i = state_.landmarks.size(); i-- > 0;) {
    const Landmark& landmark = state_.landmarks[i];
    if (landmark.hits < config_.confirm && tick - landmark.last_seen_tick > kTentativeTicks) forget(i);
  }
}

void FieldMapper::fill(msg::FieldMap& map) const {
  map.line_colour = state_.line_colour;
  // A line with more points than the message has room for is published with a greater spacing.
  constexpr auto kRoom = static_cast<std::size_t>(msg::kMaxMapLinePoints);
  const std::size_t known = state_.line_x_m.size(), stride = std::max<std::size_t>(1, (known + kRoom - 1) / kRoom);
  map.line_point_count = 0;
  for (std::size_t i = 0; i < known; i += stride) {
    map.line_x_m[map.line_point_count] = state_.line_x_m[i];
    map.line_y_m[map.line_point_count++] = state_.line_y_m[i];
  }
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
    out.height_m = landmark.height_m > 0.0 ? landmark.height_m : kNan;
    out.sd_m = sd(landmark);
    out.touched = landmark.felt;
    out.carried = landmark.carried;
    out.last_seen_tick = landmark.last_seen_tick;
    out.object_probability = probability_of(landmark.object_log_odds);
  }
  map.touch_count = static_cast<std::uint16_t>(state_.felt.size());
  for (std::size_t i = 0; i < state_.felt.size(); ++i) {
    const Felt& felt = state_.felt[i];
    map.touches[i] = {felt.x_m, felt.y_m, felt.force_n, felt.module_index, felt.tick, felt.handle};
  }
  map.obstacle_count = 0;
  for (const Obstacle& obstacle : state_.obstacles) {
    if (!believed(obstacle)) continue;
    map.obstacle_x_m[map.obstacle_count] = obstacle.x_m;
    map.obstacle_y_m[map.obstacle_count] = obstacle.y_m;
    map.obstacle_felt[map.obstacle_count++] = obstacle.felt;
  }
}

}  // namespace constrictor::guidance
