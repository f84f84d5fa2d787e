// Follow path: the robot follows a polyline of waypoints in the map instead of a painted line. Control gets the part of
// the path that lies ahead, and steers to it. This task is not the paper's: it serves planners that use waypoints. It
// ends when the head is at the last one.
#include <algorithm>
#include <cereal/types/vector.hpp>
#include <cmath>

#include "navigation/motions.hpp"

namespace constrictor {
namespace {

struct FollowPathState {
  std::vector<double> x_m, y_m;  ///< the path in M
  std::size_t segment = 0;       ///< the head is beside this segment; never decreases, so that a path may cross itself
  double along_m = 0.0;          ///< the head's place along the segment, from its first point
  double before_m = 0.0;         ///< length of all earlier segments
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, segment, along_m, before_m);
  }
};

class FollowPath : public StatefulTask<FollowPathState> {
 public:
  /// The path lies in the map.
  [[nodiscard]] bool steers_by_sight() const override { return false; }
  std::string refusal(const TaskInput& input, const Grip&) const override {
    FollowPathState path = take(*input.path);
    advance(input.X_MH.p, path);
    const double distance_m = (input.X_MH.p - at(path, path.segment, path.along_m)).norm();
    return distance_m > input.config.follow_path.lost_m ? "follow_path: the path is too far from the robot" : "";
  }
  void start(const TaskInput& input, Grip&) override { state_ = take(*input.path); }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const auto& config = input.config.follow_path;
    advance(input.X_MH.p, state_);
    const PlanarPose X_MP{at(state_, state_.segment, state_.along_m), heading(state_, state_.segment)};
    output.cross_track_m = X_MP.to_local(input.X_MH.p).y();
    move_on_path(input, ahead(X_MP.p), grip, output);
    output.phase = "follow";
    double total_m = 0.0;
    for (std::size_t i = 0; i + 1 < state_.x_m.size(); ++i) total_m += length(state_, i);
    const double done_m = state_.before_m + state_.along_m;
    output.progress = std::min(1.0, done_m / total_m);
    if (done_m >= total_m - config.reached_m) {
      output.succeed();
    } else if ((input.X_MH.p - X_MP.p).norm() > config.lost_m) {
      output.abort("too far from the path");
    }
  }

 private:
  static FollowPathState take(const msg::Path& path) {
    const std::size_t count = std::min<std::size_t>(path.point_count, msg::kMaxPathPoints);
    FollowPathState state;
    state.x_m.assign(path.x_m, path.x_m + count);
    state.y_m.assign(path.y_m, path.y_m + count);
    return state;
  }
  static Eigen::Vector2d point(const FollowPathState& path, std::size_t i) { return {path.x_m[i], path.y_m[i]}; }
  static double length(const FollowPathState& path, std::size_t i) {
    return (point(path, i + 1) - point(path, i)).norm();
  }
  static double heading(const FollowPathState& path, std::size_t i) {
    return std::atan2(path.y_m[i + 1] - path.y_m[i], path.x_m[i + 1] - path.x_m[i]);
  }
  static Eigen::Vector2d at(const FollowPathState& path, std::size_t i, double along_m) {
    return point(path, i) + along_m / length(path, i) * (point(path, i + 1) - point(path, i));
  }
  /// Moves `segment` and `along_m` on to the place of the path beside the head.
  static void advance(const Eigen::Vector2d& p_MH, FollowPathState& path) {
    for (;;) {
      const PlanarPose X_MS{point(path, path.segment), heading(path, path.segment)};
      const double length_m = length(path, path.segment);
      path.along_m = std::max(path.along_m, std::clamp(X_MS.to_local(p_MH).x(), 0.0, length_m));
      if (path.segment + 2 >= path.x_m.size()) return;
      // At a sharp corner the head leaves a segment before it has been beside the segment's end.
      const PlanarPose X_MN{point(path, path.segment + 1), heading(path, path.segment + 1)};
      const double next_m = X_MN.to_local(p_MH).x();
      const bool nearer = next_m > 0.0 && next_m < length(path, path.segment + 1) &&
                          std::abs(X_MN.to_local(p_MH).y()) < (p_MH - at(path, path.segment, path.along_m)).norm();
      if (path.along_m < length_m && !nearer) return;
      path.before_m += length_m;
      path.along_m = 0.0;
      ++path.segment;
    }
  }
  /// The path from the place beside the head to its end, in M. Beside the last point, the last segment continues.
  [[nodiscard]] std::vector<Eigen::Vector2d> ahead(const Eigen::Vector2d& p_MP) const {
    constexpr double kApart_m = 1e-3;
    std::vector<Eigen::Vector2d> points = {p_MP};
    for (std::size_t i = state_.segment + 1; i < state_.x_m.size(); ++i) {
      if ((point(state_, i) - points.back()).norm() > kApart_m) points.push_back(point(state_, i));
    }
    const double yaw_rad = heading(state_, state_.x_m.size() - 2);
    if (points.size() < 2) points.emplace_back(p_MP + Eigen::Vector2d(std::cos(yaw_rad), std::sin(yaw_rad)));
    return points;
  }
};

}  // namespace

std::unique_ptr<Task> make_follow_path() { return std::make_unique<FollowPath>(); }

}  // namespace constrictor
