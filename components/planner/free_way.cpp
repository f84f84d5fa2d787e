#include "planner/free_way.hpp"

#include <algorithm>
#include <cmath>

#include "robot/landmarks.hpp"

namespace constrictor {
namespace {

/// A straight way between two points that are not the same.
class StraightWay {
 public:
  StraightWay(MapPoint from, MapPoint to)
      : from_(from), x_m_(to.x_m - from.x_m), y_m_(to.y_m - from.y_m), length_m_(std::hypot(x_m_, y_m_)) {}
  /// Whether a point lies within `room_m` of the way, and at least `begin_m` along it.
  [[nodiscard]] bool passes(MapPoint p, double room_m, double begin_m) const {
    if (length_m_ < 1e-6) return false;
    const double dx_m = p.x_m - from_.x_m, dy_m = p.y_m - from_.y_m;
    const double along_m = (dx_m * x_m_ + dy_m * y_m_) / length_m_;
    const double before_m = std::max(0.0, along_m - length_m_);
    return along_m >= begin_m && std::hypot(before_m, (dy_m * x_m_ - dx_m * y_m_) / length_m_) < room_m;
  }

 private:
  MapPoint from_;
  double x_m_, y_m_, length_m_;
};

/// Whether the way passes any obstacle of the map.
bool is_blocked(const msg::FieldMap& map, const StraightWay& way, double room_m, double begin_m) {
  const auto count = std::min<std::size_t>(map.obstacle_count, msg::kMaxMapObstacles);
  for (std::size_t i = 0; i < count; ++i) {
    if (way.passes({map.obstacle_x_m[i], map.obstacle_y_m[i]}, room_m, begin_m)) return true;
  }
  return false;
}

constexpr double kBeside_m = 0.1;

}  // namespace

bool is_free_way(const msg::FieldMap& map, MapPoint from, MapPoint to, double room_m) {
  return !is_blocked(map, StraightWay(from, to), room_m, kBeside_m);
}

bool is_free_of_objects(const msg::FieldMap& map, MapPoint from, MapPoint to, double room_m) {
  const StraightWay way(from, to);
  const auto landmarks = landmarks_of(map);
  return std::none_of(landmarks.begin(), landmarks.end(), [&](const msg::MapObject& landmark) {
    return landmark.kind == msg::kBlobObject && !landmark.carried &&
           way.passes({landmark.x_m, landmark.y_m}, room_m + radius_or(landmark, 0.0), kBeside_m);
  });
}

bool is_caught(const msg::FieldMap& map, const msg::MapObject& held, MapPoint head, double room_m, double ahead_m) {
  const double x_m = head.x_m - held.x_m, y_m = head.y_m - held.y_m;
  const double length_m = std::hypot(x_m, y_m);
  if (length_m < 1e-6) return false;
  const double scale = (length_m + ahead_m - room_m) / length_m;  // the end is round, with the radius room_m
  return is_blocked(map, StraightWay({held.x_m, held.y_m}, {held.x_m + scale * x_m, held.y_m + scale * y_m}), room_m,
                    0.0);
}

}  // namespace constrictor
