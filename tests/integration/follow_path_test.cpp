// A path of waypoints is followed on the real physics, by the robot's own estimate of where it is: the error that navigation reports
// is compared with ground truth. In one process, no camera.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "control/control.hpp"
#include "guidance/guidance.hpp"
#include "navigation/navigation.hpp"
#include "runtime/local_run.hpp"
#include "runtime/share.hpp"
#include "sim/physics/physics.hpp"

namespace constrictor {
namespace {

struct Point {
  double x_m, y_m;
};

/// In M: straight for a moment, then an S of radius 1.25 m.
std::vector<Point> s_curve() {
  std::vector<Point> path{{0, 0}};
  double yaw_rad = 0;
  for (int i = 0; i < 20; ++i) {
    path.push_back({path.back().x_m + 0.25 * std::cos(yaw_rad), path.back().y_m + 0.25 * std::sin(yaw_rad)});
    yaw_rad += i < 3 ? 0.0 : i < 9 ? 0.2 : i < 17 ? -0.2 : 0.0;
  }
  return path;
}

class PathCommand : public StatefulComponent<int> {
 public:
  explicit PathCommand(Wiring& wiring) : out_(wiring.output(topics::kTaskCommand)) {}
  void step(const Tick& tick) override {
    if (tick.index != 25) return;
    const auto path = s_curve();
    msg::TaskCommand command{};
    command.goal_id = 1;
    command.task = msg::kTaskFollowPath;
    command.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
    command.path.point_count = static_cast<std::uint16_t>(path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      command.path.x_m[i] = path[i].x_m;
      command.path.y_m[i] = path[i].y_m;
    }
    out_.write(command);
  }

 private:
  Output<msg::TaskCommand> out_;
};

/// Ground truth in M, the head's pose at the start.
struct Truth {
  bool known = false;
  double x0_m = 0, y0_m = 0, yaw0_rad = 0;
  Point in_map(const msg::WorldState& world) {
    const auto& head = world.module_poses[0];
    if (!known) {
      const auto& q = head.orientation;
      *this = {true, head.position_m.x, head.position_m.y, std::atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))};
    }
    const double dx_m = head.position_m.x - x0_m;
    const double dy_m = head.position_m.y - y0_m;
    return {dx_m * std::cos(yaw0_rad) + dy_m * std::sin(yaw0_rad), dy_m * std::cos(yaw0_rad) - dx_m * std::sin(yaw0_rad)};
  }
};

/// Signed distance from a polyline, positive to its left.
double cross_track_m(const std::vector<Point>& path, const Point& p) {
  double best_m = 1e9;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double dx_m = path[i + 1].x_m - path[i].x_m;
    const double dy_m = path[i + 1].y_m - path[i].y_m;
    const double length_m = std::hypot(dx_m, dy_m);
    const double along_m = std::clamp(((p.x_m - path[i].x_m) * dx_m + (p.y_m - path[i].y_m) * dy_m) / length_m, 0.0, length_m);
    const double away_x_m = p.x_m - path[i].x_m - along_m * dx_m / length_m;
    const double away_y_m = p.y_m - path[i].y_m - along_m * dy_m / length_m;
    const double distance_m = std::hypot(away_x_m, away_y_m);
    if (distance_m < std::abs(best_m)) best_m = std::copysign(distance_m, dx_m * away_y_m - dy_m * away_x_m);
  }
  return best_m;
}

TEST(FollowPathOnPhysics, ComesToTheEndAndReportsTheErrorThatGroundTruthSees) {
  constrictor::Setup setup;
  setup.robot_file = share_path("components/robot/mamba.yaml");
  setup.scenario_file = share_path("sim/scenarios/line.yaml");
  setup.seed = 1;
  LocalRun run({make_physics_factory(), make_guidance_factory(), make_navigation_factory(), make_control_factory(),
                {"input", [](Wiring& w, const constrictor::Setup&) { return std::make_unique<PathCommand>(w); }}},
               setup);
  const auto path = s_curve();
  Truth truth;
  Point head{};
  double true_squares = 0, reported_squares = 0, difference_squares = 0;
  int count = 0;
  std::uint8_t state = msg::kGoalIdle;
  run.subscribe<msg::WorldState>(topics::kWorldState, [&](const msg::WorldState& world) { head = truth.in_map(world); });
  run.subscribe<msg::TaskStatus>(topics::kTaskStatus, [&](const msg::TaskStatus& status) {
    state = status.state;
    if (!std::isfinite(status.cross_track_m)) return;
    const double true_m = cross_track_m(path, head);
    true_squares += true_m * true_m;
    reported_squares += status.cross_track_m * status.cross_track_m;
    difference_squares += std::pow(status.cross_track_m - true_m, 2);
    ++count;
  });
  for (int i = 0; i < 30 && state != msg::kGoalSucceeded && state != msg::kGoalAborted; ++i) run.advance(50);
  EXPECT_EQ(state, msg::kGoalSucceeded);
  ASSERT_GT(count, 200);
  const double true_rms_m = std::sqrt(true_squares / count);
  RecordProperty("true_rms_mm", static_cast<int>(1000 * true_rms_m));
  std::printf("cross-track error: true %.3f m rms, reported %.3f m rms, difference %.3f m rms, %d ticks\n", true_rms_m,
              std::sqrt(reported_squares / count), std::sqrt(difference_squares / count), count);
  EXPECT_LT(true_rms_m, 0.12);  // line following by camera reaches 0.08 to 0.09, undulation of the head included
  EXPECT_LT(std::sqrt(difference_squares / count), 0.05);
  EXPECT_LT(std::hypot(head.x_m - path.back().x_m, head.y_m - path.back().y_m), 0.25);
}

}  // namespace
}  // namespace constrictor
