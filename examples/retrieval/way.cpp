// The part of the retrieval logic that remembers the line and computes from it the directions to which the robot turns.
#include <algorithm>
#include <cmath>

#include "retrieval.hpp"

namespace retrieval {
namespace {

// Largest angle [rad] between head and body at which a body without an object is straight enough to follow a line.
constexpr double kStraight_rad = 0.6;

}  // namespace

const Retrieval::TrailPoint* Retrieval::nearest_trail_point(double x_m, double y_m) const {
  const auto distance = [&](const TrailPoint& point) { return std::hypot(point.x_m - x_m, point.y_m - y_m); };
  const auto best = std::min_element(trail_.begin(), trail_.end(), [&](const TrailPoint& a, const TrailPoint& b) {
    return distance(a) < distance(b);
  });
  return best == trail_.end() ? nullptr : &*best;
}

std::optional<double> Retrieval::off_line_rad() const {
  const TrailPoint* point = nearest_trail_point(pose_.x_m, pose_.y_m);
  if (!point) return std::nullopt;
  return wrapped(point->outbound_rad + (loaded() ? kPi : 0.0) - course_rad());
}

bool Retrieval::may_follow() const {
  const auto off_rad = off_line_rad();
  const bool curled = !loaded() && std::abs(wrapped(pose_.yaw_rad - pose_.body_yaw_rad)) > kStraight_rad;
  return !curled && (!off_rad || std::abs(*off_rad) < kAligned_rad);
}

std::optional<double> Retrieval::to_turn_rad() const {
  const auto towards = [&](double x_m, double y_m) {
    return wrapped(std::atan2(y_m - pose_.y_m, x_m - pose_.x_m) - course_rad());
  };
  const auto distance_m = [&](double x_m, double y_m) { return std::hypot(x_m - pose_.x_m, y_m - pose_.y_m); };
  const bool looks = stage_ == kLook || stage_ == kFindLine;
  const auto place = places_.find({colour(), loaded()});
  if (looks && place != places_.end()) {
    const auto [x_m, y_m] = place->second;
    if (distance_m(x_m, y_m) > 0.3 && distance_m(x_m, y_m) < 2.5) return towards(x_m, y_m);
  }
  const TrailPoint* point = nearest_trail_point(pose_.x_m, pose_.y_m);
  if (!point || distance_m(point->x_m, point->y_m) < 0.5) return off_line_rad();
  const double ahead_m = loaded() ? -0.6 : 0.6;  // far from the line: turn to a point ahead on it
  return towards(point->x_m + ahead_m * std::cos(point->outbound_rad),
                 point->y_m + ahead_m * std::sin(point->outbound_rad));
}

bool Retrieval::has_turned() const {
  const auto turn_rad = to_turn_rad();
  if (!turn_rad) return false;
  const bool past = turning_left_ ? *turn_rad < 0 : *turn_rad > 0;
  return std::abs(*turn_rad) < 0.2 || (past && std::abs(*turn_rad) < kAligned_rad);
}

std::vector<std::pair<double, double>> Retrieval::way_back() const {
  const TrailPoint* point = nearest_trail_point(pose_.x_m, pose_.y_m);
  std::vector<std::pair<double, double>> path;
  if (!point) return path;
  if (std::hypot(point->x_m - pose_.x_m, point->y_m - pose_.y_m) > 0.2) path.emplace_back(pose_.x_m, pose_.y_m);
  const int step = loaded() ? -1 : 1;
  const int last = loaded() ? -1 : static_cast<int>(trail_.size());
  for (int i = static_cast<int>(point - trail_.data()); i != last && path.size() < 64; i += step) {
    path.emplace_back(trail_[static_cast<std::size_t>(i)].x_m, trail_[static_cast<std::size_t>(i)].y_m);
  }
  return path;
}

}  // namespace retrieval
