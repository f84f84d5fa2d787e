// The part of FieldMapper that maps obstacles: what stands on the ground, or was touched, and is no object.
#include <algorithm>
#include <cmath>

#include "guidance/field_mapper.hpp"

namespace constrictor::guidance {
namespace {

constexpr double kSameTouch_m = 0.06;
constexpr double kInside_m = 0.015;       // inside a module: an obstacle that is still there keeps the body out
constexpr double kBesideBody_m = 0.05;    // a point that is nearer to the body may be one of its modules
constexpr double kBesideObject_m = 0.08;  // a point that is nearer to an object may be its dark side
constexpr double kAcross_m = 0.04;        // points that are farther apart across the line of sight are different ones
constexpr double kNearSd_m = 0.015;       // of a point close to the camera, along the line of sight
constexpr double kFarSd_1_m = 0.06;       // times the squared range: about a pixel of a camera 0.085 m above the ground
constexpr double kInflation = 2.0;        // of the standard deviation: successive images have common errors
constexpr double kLeastSd_m = 0.01;
constexpr double kDoubted_m = 1.0;          // a more distant obstacle need not be seen
constexpr double kPoint_m = 0.02;           // radius of a point as landmark
constexpr double kScreen_m = 0.03;          // the same as a screen
constexpr std::int64_t kUnseenTicks = 150;  // obstacles that are not believed and not seen for this long are forgotten

}  // namespace

bool FieldMapper::believed(const Obstacle& obstacle) const {
  return obstacle.felt || obstacle.hits >= config_.obstacle_confirm;
}

Obstacle* FieldMapper::obstacle_at(const Eigen::Vector2d& p_M, const Eigen::Vector2d& sight, double sd_m) {
  Obstacle* nearest = nullptr;
  double nearest_m = 1e9;
  for (Obstacle& obstacle : state_.obstacles) {
    const Eigen::Vector2d d = Eigen::Vector2d(obstacle.x_m, obstacle.y_m) - p_M;
    const double along_m = std::abs(d.dot(sight)), across_m = std::abs(sight.x() * d.y() - sight.y() * d.x());
    const double gate_m = 2.0 * std::hypot(sd_m, obstacle.sd_m) + kAcross_m;
    if (across_m > kAcross_m || along_m > gate_m || d.norm() >= nearest_m) continue;
    nearest = &obstacle;
    nearest_m = d.norm();
  }
  return nearest;
}

bool FieldMapper::is_near_body(const BodyChain& chain, const Eigen::Vector2d& p, double distance_m) const {
  const double half_m = 0.5 * model_.module_length_m;
  return std::any_of(chain.begin(), chain.end(), [&](const PlanarPose& module) {
    Eigen::Vector2d local = module.to_local(p);
    local.x() -= std::clamp(local.x(), -half_m, half_m);
    return local.norm() < distance_m;
  });
}

bool FieldMapper::is_no_obstacle(const Eigen::Vector2d& p, const BodyChain& chain) const {
  if (is_near_body(chain, p, model_.module_radius_m + kBesideBody_m)) return true;
  const Eigen::Vector2d p_M = to_parent(filter_.pose(), p);
  return std::any_of(state_.landmarks.begin(), state_.landmarks.end(), [&](const Landmark& landmark) {
    return landmark.kind == msg::kBlobObject &&
           (position(landmark) - p_M).norm() < radius_of(landmark) + sd(landmark) + kBesideObject_m;
  });
}

void FieldMapper::add_obstacle(const Obstacle& obstacle) {
  if (state_.obstacles.size() >= static_cast<std::size_t>(msg::kMaxMapObstacles))
    state_.obstacles.erase(state_.obstacles.begin());
  state_.obstacles.push_back(obstacle);
}

void FieldMapper::obstacles(const msg::ObjectPercepts& percepts, const PlanarPose& exposure, const BodyChain& chain,
                            bool level, std::int64_t tick) {
  const PlanarPose X_HV = view_of(percepts, exposure);
  const int count = std::min<int>(percepts.obstacle_count, msg::kMaxPerceptObstacles);
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d p_V(percepts.obstacle_x_m[i], percepts.obstacle_y_m[i]);
    const Eigen::Vector2d p = to_parent(X_HV, p_V);
    if (is_no_obstacle(p, chain)) continue;
    const Eigen::Vector2d p_M = to_parent(filter_.pose(), p);
    const Eigen::Vector2d sight = along(filter_.pose().yaw_rad + X_HV.yaw_rad + std::atan2(p_V.y(), p_V.x()));
    const double sd_m = kInflation * (kNearSd_m + kFarSd_1_m * p_V.squaredNorm());
    Obstacle* known = obstacle_at(p_M, sight, sd_m);
    if (known == nullptr) {
      add_obstacle({p_M.x(), p_M.y(), sd_m, 1, 0, false, tick});
      continue;
    }
    if (!known->felt) {  // a touch shows the place better than any image
      const double variance = known->sd_m * known->sd_m, share = variance / (variance + sd_m * sd_m);
      known->x_m += share * (p_M.x() - known->x_m);
      known->y_m += share * (p_M.y() - known->y_m);
      known->sd_m = std::max(kLeastSd_m, std::sqrt((1.0 - share) * variance));
    }
    if (known->last_seen_tick != tick) known->hits = std::min(known->hits + 1, config_.obstacle_confirm);
    known->misses = 0;
    known->last_seen_tick = tick;
  }
  doubt_obstacles(percepts, X_HV, chain, level, tick);
}

void FieldMapper::doubt_obstacles(const msg::ObjectPercepts& percepts, const PlanarPose& X_HV, const BodyChain& chain,
                                  bool level, std::int64_t tick) {
  std::optional<View> view = view_with_body(percepts, X_HV, chain);
  if (!view) return;
  const auto disc_at = [&](double x_m, double y_m, double radius_m, double sd_m) {
    return Disc{X_HV.to_local(filter_.pose().to_local({x_m, y_m})), radius_m, sd_m};
  };
  for (const Landmark& landmark : state_.landmarks) {
    if (landmark.kind != msg::kBlobObject) continue;
    const Eigen::Vector2d p = position(landmark);
    view->screens.push_back(disc_at(p.x(), p.y(), radius_of(landmark), sd(landmark)));
  }
  // What is seen in the direction of the obstacle, and nearer, hides it.
  for (int i = 0; i < std::min<int>(percepts.obstacle_count, msg::kMaxPerceptObstacles); ++i)
    view->screens.push_back({{percepts.obstacle_x_m[i], percepts.obstacle_y_m[i]}, kScreen_m, 0.0});

  std::erase_if(state_.obstacles, [&](Obstacle& obstacle) {
    if (obstacle.felt || obstacle.last_seen_tick == tick) return false;
    const Disc disc = disc_at(obstacle.x_m, obstacle.y_m, kPoint_m, 0.0);
    const bool missed = level && (disc.p - view->p_VC).norm() < kDoubted_m &&
                        clearly_in_view(config_.existence, *view, disc, msg::kColourUnknown);
    if (missed) ++obstacle.misses;
    return obstacle.misses >= config_.obstacle_misses ||
           (!believed(obstacle) && tick - obstacle.last_seen_tick > kUnseenTicks);
  });
}

void FieldMapper::feel_obstacle(const Eigen::Vector2d& p_M) {
  for (Obstacle& obstacle : state_.obstacles) {
    if (std::hypot(obstacle.x_m - p_M.x(), obstacle.y_m - p_M.y()) >= kSameTouch_m) continue;
    if (obstacle.felt) return;
    obstacle.x_m = p_M.x();
    obstacle.y_m = p_M.y();
    obstacle.felt = true;
    return;
  }
  add_obstacle({p_M.x(), p_M.y(), kLeastSd_m, 0, 0, true, 0});
}

void FieldMapper::clear_obstacles(const BodyChain& chain) {
  std::erase_if(state_.obstacles, [&](const Obstacle& obstacle) {
    const Eigen::Vector2d p = filter_.pose().to_local({obstacle.x_m, obstacle.y_m});
    return is_near_body(chain, p, model_.module_radius_m - kInside_m);
  });
}

}  // namespace constrictor::guidance
