#include "planner/line_trail.hpp"

#include <cmath>
#include <numbers>

namespace constrictor {
namespace {
constexpr double kSpacing_m = 0.3;
constexpr std::size_t kMostCrumbs = 400;  // 120 m of line
}  // namespace

double wrapped(double angle_rad) { return std::remainder(angle_rad, 2.0 * std::numbers::pi); }

const Crumb* LineTrail::nearest(double x_m, double y_m) const {
  const Crumb* best = nullptr;
  double best_m = 0.0;
  for (const Crumb& crumb : crumbs_) {
    const double distance_m = std::hypot(crumb.x_m - x_m, crumb.y_m - y_m);
    if (best && distance_m >= best_m) continue;
    best = &crumb;
    best_m = distance_m;
  }
  return best;
}

void LineTrail::record(const msg::LinePercept& line, const msg::RobotPose& pose, bool outbound) {
  if (!line.visible || !std::isfinite(line.offset_m) || !std::isfinite(line.heading_rad) || !std::isfinite(line.lookahead_m)) return;
  const double c = std::cos(pose.yaw_rad);
  const double s = std::sin(pose.yaw_rad);
  const double x_m = pose.x_m + c * line.lookahead_m - s * line.offset_m;
  const double y_m = pose.y_m + s * line.lookahead_m + c * line.offset_m;
  const Crumb* known = nearest(x_m, y_m);
  if (known && std::hypot(known->x_m - x_m, known->y_m - y_m) < kSpacing_m) return;
  if (crumbs_.size() >= kMostCrumbs) crumbs_.erase(crumbs_.begin());
  crumbs_.push_back({x_m, y_m, wrapped(pose.yaw_rad + line.heading_rad + (outbound ? 0.0 : std::numbers::pi))});
}

std::optional<double> LineTrail::direction_rad(const msg::RobotPose& pose, bool outbound) const {
  const Crumb* crumb = nearest(pose.x_m, pose.y_m);
  if (!crumb) return std::nullopt;
  return wrapped(crumb->outbound_rad + (outbound ? 0.0 : std::numbers::pi));
}

std::optional<double> LineTrail::heading_rad(const msg::RobotPose& pose, bool outbound) const {
  constexpr double kBeside_m = 0.5;
  constexpr double kJoinAhead_m = 0.6;
  const Crumb* crumb = nearest(pose.x_m, pose.y_m);
  if (!crumb) return std::nullopt;
  if (std::hypot(crumb->x_m - pose.x_m, crumb->y_m - pose.y_m) < kBeside_m) return direction_rad(pose, outbound);
  const double way = outbound ? kJoinAhead_m : -kJoinAhead_m;
  const double x_m = crumb->x_m + way * std::cos(crumb->outbound_rad);
  const double y_m = crumb->y_m + way * std::sin(crumb->outbound_rad);
  return std::atan2(y_m - pose.y_m, x_m - pose.x_m);
}

void LineTrail::reverse() {
  for (Crumb& crumb : crumbs_) crumb.outbound_rad = wrapped(crumb.outbound_rad + std::numbers::pi);
}

}  // namespace constrictor
