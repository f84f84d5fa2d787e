// follow_path with simulated physics and guidance's pose estimate: the cross-track error that navigation reports is
// compared with ground truth. All components run in one process, without a camera.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "control/control.hpp"
#include "guidance/guidance.hpp"
#include "navigation/navigation.hpp"
#include "robot/planar_message.hpp"
#include "sim/physics/physics.hpp"
#include "support/scripted_members.hpp"
#include "support/waypoints.hpp"

namespace constrictor {
namespace {

using testing::Point;

/// Stands for the component `input`: starts follow_path at tick 25.
ComponentFactory path_command() {
  return testing::scripted_writer<msg::TaskCommand>("input", topics::kTaskCommand,
                                                    [](const Tick& tick, const auto& out) {
                                                      if (tick.index == 25)
                                                        out.write(testing::follow_path_command(testing::s_curve()));
                                                    });
}

/// Ground truth in frame M, which is the head's pose at the start.
struct Truth {
  std::optional<PlanarPose> X_WM;
  Point in_map(const msg::WorldState& world) {
    const PlanarPose X_WH = planar(world.module_poses[0]);
    if (!X_WM) X_WM = X_WH;
    const Eigen::Vector2d p_M = X_WM->to_local(X_WH.p);
    return {p_M.x(), p_M.y()};
  }
};

/// Signed distance from a polyline, positive to its left.
double cross_track_m(const std::vector<Point>& path, const Point& p) {
  double best_m = 1e9;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double dx_m = path[i + 1].x_m - path[i].x_m;
    const double dy_m = path[i + 1].y_m - path[i].y_m;
    const double length_m = std::hypot(dx_m, dy_m);
    const double along_m =
        std::clamp(((p.x_m - path[i].x_m) * dx_m + (p.y_m - path[i].y_m) * dy_m) / length_m, 0.0, length_m);
    const double away_x_m = p.x_m - path[i].x_m - along_m * dx_m / length_m;
    const double away_y_m = p.y_m - path[i].y_m - along_m * dy_m / length_m;
    const double distance_m = std::hypot(away_x_m, away_y_m);
    if (distance_m < std::abs(best_m)) best_m = std::copysign(distance_m, dx_m * away_y_m - dy_m * away_x_m);
  }
  return best_m;
}

TEST(FollowPathOnPhysics, ReachesTheEndAndReportsTheTrueError) {
  constrictor::Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  setup.scenario_file = data_path("sim/scenarios/line.yaml");
  setup.seed = 1;
  LocalRun run({make_physics_factory(), make_guidance_factory(), make_navigation_factory(), make_control_factory(),
                path_command()},
               setup);
  const auto path = testing::s_curve();
  Truth truth;
  Point head{};
  double true_squares = 0, reported_squares = 0, difference_squares = 0;
  int count = 0;
  std::uint8_t state = msg::kGoalIdle;
  run.subscribe<msg::WorldState>(topics::kWorldState,
                                 [&](const msg::WorldState& world) { head = truth.in_map(world); });
  run.subscribe<msg::TaskStatus>(topics::kTaskStatus, [&](const msg::TaskStatus& status) {
    state = status.goal_state;
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
  EXPECT_LT(true_rms_m, 0.12);  // following a painted line reaches 0.08 to 0.09 m, including the sway of the head
  // Without anything in view, the pose is dead reckoning on ground whose friction the robot does not know.
  EXPECT_LT(std::sqrt(difference_squares / count), 0.1);
  EXPECT_LT(std::hypot(head.x_m - path.back().x_m, head.y_m - path.back().y_m), 0.3);
}

}  // namespace
}  // namespace constrictor
