#include "planner/free_way.hpp"

#include <algorithm>
#include <cmath>

#include "robot/landmarks.hpp"
#include "robot/map_points.hpp"

namespace constrictor {
namespace {

/// A straight way between two points of M that are not the same.
class StraightWay {
 public:
  StraightWay(const Eigen::Vector2d& from, const Eigen::Vector2d& to)
      : from_(from), way_(to - from), length_m_(way_.norm()) {}
  /// Whether a point lies within `room_m` of the way, and at least `begin_m` along it.
  [[nodiscard]] bool passes(const Eigen::Vector2d& p, double room_m, double begin_m) const {
    if (length_m_ < 1e-6) return false;
    const Eigen::Vector2d d = p - from_;
    const double along_m = d.dot(way_) / length_m_;
    const double across_m = (d.y() * way_.x() - d.x() * way_.y()) / length_m_;
    return along_m >= begin_m && std::hypot(std::max(0.0, along_m - length_m_), across_m) < room_m;
  }

 private:
  Eigen::Vector2d from_, way_;
  double length_m_;
};

/// Whether the way passes any obstacle of the map.
bool is_blocked(const msg::FieldMap& map, const StraightWay& way, double room_m, double begin_m) {
  bool blocked = false;
  each_obstacle(map, [&](const Eigen::Vector2d& p) { blocked = blocked || way.passes(p, room_m, begin_m); });
  return blocked;
}

constexpr double kBeside_m = 0.1;

}  // namespace

bool is_free_way(const msg::FieldMap& map, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double room_m) {
  return !is_blocked(map, StraightWay(from, to), room_m, kBeside_m);
}

bool is_free_of_objects(const msg::FieldMap& map, const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                        double room_m) {
  const StraightWay way(from, to);
  const auto landmarks = landmarks_of(map);
  return std::none_of(landmarks.begin(), landmarks.end(), [&](const msg::MapObject& landmark) {
    return landmark.kind == msg::kBlobObject && !landmark.carried &&
           way.passes({landmark.x_m, landmark.y_m}, room_m + radius_or(landmark, 0.0), kBeside_m);
  });
}

bool is_caught(const msg::FieldMap& map, const msg::MapObject& held, const Eigen::Vector2d& head, double room_m,
               double ahead_m) {
  const Eigen::Vector2d from(held.x_m, held.y_m), arm = head - from;
  if (arm.norm() < 1e-6) return false;
  const double scale = (arm.norm() + ahead_m - room_m) / arm.norm();  // the end is round, with the radius room_m
  return is_blocked(map, StraightWay(from, from + scale * arm), room_m, 0.0);
}

}  // namespace constrictor
