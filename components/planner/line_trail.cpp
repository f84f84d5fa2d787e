#include "planner/line_trail.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "robot/planar.hpp"

namespace constrictor {
namespace {
constexpr double kSpacing_m = 0.3;       // between recorded points
constexpr double kNewGround_m = 0.45;    // from every recorded point, if the robot knows where it is
constexpr double kOpposite_rad = 2.4;    // between the directions of neighbouring points: one of them is wrong
constexpr double kFrontier_m = 1.5;      // radius of the frontier's neighbourhood
constexpr std::size_t kMaxPoints = 400;  // 120 m of line

/// A point of frame G, for the head at `pose`, in M.
LinePoint in_map(const msg::RobotPose& pose, double x_m, double y_m) {
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  return {pose.x_m + c * x_m - s * y_m, pose.y_m + s * x_m + c * y_m, true};
}
/// [m] beyond which a point that is seen from `pose` cannot be a recorded one. After a loss of the line the estimated
/// pose is up to three and a half times as wrong as its standard deviation says.
double new_ground_m(const msg::RobotPose& pose) {
  constexpr double kDoubt = 3.5;
  const double sd_m = std::sqrt(std::max(pose.covariance[0], pose.covariance[4]));
  return std::max(kNewGround_m, kDoubt * sd_m);
}
/// The farthest visible point of the line, in M.
LinePoint farthest(const msg::LinePercept& line, const msg::RobotPose& pose) {
  const std::size_t count = std::min<std::size_t>(line.point_count, msg::kMaxPerceptPoints);
  if (!line.visible || count == 0) return {};
  const double x_m = line.x_m[count - 1];
  const double y_m = line.y_m[count - 1];
  return std::isfinite(x_m) && std::isfinite(y_m) ? in_map(pose, x_m, y_m) : LinePoint{};
}

}  // namespace

const TrailPoint* LineTrail::nearest(double x_m, double y_m) const {
  const TrailPoint* best = nullptr;
  double best_m = 0.0;
  for (const TrailPoint& point : points_) {
    const double distance_m = std::hypot(point.x_m - x_m, point.y_m - y_m);
    if (best && distance_m >= best_m) continue;
    best = &point;
    best_m = distance_m;
  }
  return best;
}

void LineTrail::record(const msg::LinePercept& line, const msg::RobotPose& pose, bool outbound) {
  if (!line.visible || !std::isfinite(line.offset_m) || !std::isfinite(line.heading_rad) ||
      !std::isfinite(line.lookahead_m))
    return;
  const auto [x_m, y_m, known_point] = in_map(pose, line.lookahead_m, line.offset_m);
  const TrailPoint* known = nearest(x_m, y_m);
  if (known && std::hypot(known->x_m - x_m, known->y_m - y_m) < kSpacing_m) return;
  const double outbound_rad = wrap_angle(pose.yaw_rad + line.heading_rad + (outbound ? 0.0 : std::numbers::pi));
  if (known && std::abs(wrap_angle(known->outbound_rad - outbound_rad)) > kOpposite_rad) return;
  if (points_.size() >= kMaxPoints) points_.erase(points_.begin());
  points_.push_back({x_m, y_m, outbound_rad});
  if (outbound) frontier_ = {x_m, y_m, true};
}

bool LineTrail::at_frontier(double x_m, double y_m) const {
  return frontier_.known && std::hypot(frontier_.x_m - x_m, frontier_.y_m - y_m) < kFrontier_m;
}

void LineTrail::note_beyond(const msg::LinePercept& line, const msg::RobotPose& pose) {
  const LinePoint point = farthest(line, pose);
  if (point.known && at_frontier(point.x_m, point.y_m)) beyond_ = point;
}

bool LineTrail::leads_to_new_ground(const msg::LinePercept& line, const msg::RobotPose& pose) const {
  const LinePoint point = farthest(line, pose);
  if (!point.known || !at_frontier(point.x_m, point.y_m)) return false;
  const TrailPoint* known = nearest(point.x_m, point.y_m);
  return std::hypot(known->x_m - point.x_m, known->y_m - point.y_m) > new_ground_m(pose);
}

std::optional<double> LineTrail::direction_rad(const msg::RobotPose& pose, bool outbound) const {
  const TrailPoint* point = nearest(pose.x_m, pose.y_m);
  if (!point) return std::nullopt;
  return wrap_angle(point->outbound_rad + (outbound ? 0.0 : std::numbers::pi));
}

std::optional<double> LineTrail::heading_rad(const msg::RobotPose& pose, bool outbound,
                                             const Reachable& reachable) const {
  constexpr double kBeside_m = 0.5;
  constexpr double kJoinAhead_m = 0.6;
  constexpr double kArrived_m = 0.3;
  const TrailPoint* point = nearest(pose.x_m, pose.y_m);
  if (!point) return std::nullopt;
  if (outbound && beyond_.known && at_frontier(pose.x_m, pose.y_m) &&
      std::hypot(beyond_.x_m - pose.x_m, beyond_.y_m - pose.y_m) > kArrived_m) {
    return std::atan2(beyond_.y_m - pose.y_m, beyond_.x_m - pose.x_m);
  }
  const auto is_reachable = [&](double x_m, double y_m) { return !reachable || reachable(x_m, y_m); };
  if (std::hypot(point->x_m - pose.x_m, point->y_m - pose.y_m) < kBeside_m && is_reachable(point->x_m, point->y_m))
    return direction_rad(pose, outbound);
  const double way = outbound ? kJoinAhead_m : -kJoinAhead_m;
  const auto ahead_of = [&](const TrailPoint& joined) {
    return LinePoint{joined.x_m + way * std::cos(joined.outbound_rad), joined.y_m + way * std::sin(joined.outbound_rad),
                     true};
  };
  LinePoint aim = ahead_of(*point);
  if (!is_reachable(aim.x_m, aim.y_m)) {
    double least_m = std::numeric_limits<double>::infinity();
    for (const TrailPoint& other : points_) {
      const LinePoint there = ahead_of(other);
      const double distance_m = std::hypot(other.x_m - pose.x_m, other.y_m - pose.y_m);
      if (distance_m >= least_m || !is_reachable(there.x_m, there.y_m)) continue;
      least_m = distance_m;
      aim = there;
    }
  }
  return std::atan2(aim.y_m - pose.y_m, aim.x_m - pose.x_m);
}

void LineTrail::reverse() {
  for (TrailPoint& point : points_) point.outbound_rad = wrap_angle(point.outbound_rad + std::numbers::pi);
  frontier_.known = beyond_.known = false;
}

}  // namespace constrictor
