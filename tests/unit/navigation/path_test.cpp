// follow_path with a point that drives along the desired curvature: it reaches the end of the path, and the reported
// cross-track error is its distance from the path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <vector>

#include "barrier/local_run.hpp"
#include "navigation/navigation.hpp"
#include "robot/trajectory_path.hpp"
#include "support/project.hpp"
#include "support/scripted_members.hpp"
#include "support/waypoints.hpp"

namespace constrictor {
namespace {

using testing::Point;

const std::vector<Point> kPath = testing::s_curve();
constexpr double kSpeed_m_s = 0.4;

/// Distance of a point from a polyline, by comparing many points of the polyline.
double distance_m(const std::vector<Point>& path, const Point& p) {
  double least_m = 1e9;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    for (int step = 0; step <= 4000; ++step) {
      const double t = step / 4000.0;
      const double x_m = path[i].x_m + t * (path[i + 1].x_m - path[i].x_m);
      const double y_m = path[i].y_m + t * (path[i + 1].y_m - path[i].y_m);
      least_m = std::min(least_m, std::hypot(p.x_m - x_m, p.y_m - y_m));
    }
  }
  return least_m;
}

struct Driven {
  double x_m = 0, y_m = 0.1, yaw_rad = 0.2;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, yaw_rad);
  }
};

/// Stands for guidance: the pose of a point that drives along the curvature that navigation wants.
class DrivenPoint : public StatefulComponent<Driven> {
 public:
  DrivenPoint(Wiring& wiring, const Setup&)
      : out_(wiring.output(topics::kRobotPose)), desired_(wiring.latest(topics::kDesiredTrajectory)) {}
  void step(const Tick& tick) override {
    if (desired_ && std::string(desired_->motion) == "travel") {
      const double step_m = kSpeed_m_s * tick.dt_s();
      state_.yaw_rad += pursuit_curvature_1_m(*desired_, 0.35) * step_m;
      state_.x_m += step_m * std::cos(state_.yaw_rad);
      state_.y_m += step_m * std::sin(state_.yaw_rad);
    }
    msg::RobotPose pose{};
    pose.x_m = state_.x_m;
    pose.y_m = state_.y_m;
    pose.yaw_rad = state_.yaw_rad;
    out_.write(pose);
  }

 private:
  Output<msg::RobotPose> out_;
  Latest<msg::DesiredTrajectory> desired_;
};

/// Stands for the component `input`: writes the command at tick 10.
ComponentFactory one_command(const msg::TaskCommand& command) {
  return testing::scripted_writer<msg::TaskCommand>("input", topics::kTaskCommand,
                                                    [command](const Tick& tick, const auto& out) {
                                                      if (tick.index == 10) out.write(command);
                                                    });
}

struct PathRun {
  std::vector<msg::TaskEvent> events;
  LocalRun run;
  explicit PathRun(const msg::TaskCommand& command)
      : run({testing::still_robot(), make_navigation_factory(), testing::member_of_class<DrivenPoint>("guidance"),
             one_command(command)},
            setup()) {
    run.subscribe<msg::TaskEvent>(topics::kTaskEvent, [this](const msg::TaskEvent& event) { events.push_back(event); });
  }
  static Setup setup() {
    Setup setup;
    setup.robot_file = testing::robot_path("mamba");
    return setup;
  }
  [[nodiscard]] std::uint8_t last_state() const { return events.empty() ? msg::kGoalIdle : events.back().goal_state; }
};

TEST(FollowPath, DrivesToTheLastPointAndReportsItsDistanceFromThePath) {
  PathRun r(testing::follow_path_command(kPath));
  std::vector<Point> poses{{0, 0.1}};  // by tick
  r.run.subscribe<msg::RobotPose>(topics::kRobotPose, [&](const msg::RobotPose& pose) {
    poses.push_back({pose.x_m, pose.y_m});
  });
  double squares = 0;
  int count = 0;
  r.run.subscribe<msg::TaskStatus>(topics::kTaskStatus, [&](const msg::TaskStatus& status) {
    if (status.goal_state != msg::kGoalRunning || !std::isfinite(status.cross_track_m)) return;
    const Point& seen = poses[static_cast<std::size_t>(status.header.tick)];  // the pose written one tick before
    EXPECT_NEAR(std::abs(status.cross_track_m), distance_m(kPath, seen), 0.03) << seen.x_m << " " << seen.y_m;
    squares += status.cross_track_m * status.cross_track_m;
    ++count;
  });
  r.run.advance(1000);
  EXPECT_EQ(r.last_state(), msg::kGoalSucceeded);
  EXPECT_NEAR(std::hypot(poses.back().x_m - kPath.back().x_m, poses.back().y_m - kPath.back().y_m), 0.1, 0.06);
  ASSERT_GT(count, 400);
  EXPECT_LT(std::sqrt(squares / count), 0.06);  // the point begins 0.1 m beside the path
}

TEST(FollowPath, TheErrorIsPositiveLeftOfThePath) {
  PathRun r(testing::follow_path_command({{0, 0}, {3, 0}}));  // the point begins 0.1 m to the left
  r.run.advance(14);
  EXPECT_NEAR(r.run.latest(topics::kTaskStatus)->cross_track_m, 0.1, 0.02);
}

TEST(FollowPath, ControlGetsThePathThatLiesAhead) {
  PathRun r(testing::follow_path_command({{0, 0}, {1, 0}, {1.5, 0.5}, {1.5, 2.0}}));
  PlanarPose X_MH;
  bool compared = false;
  r.run.subscribe<msg::RobotPose>(topics::kRobotPose, [&](const msg::RobotPose& pose) {
    X_MH = {{pose.x_m, pose.y_m}, pose.yaw_rad};
  });
  r.run.subscribe<msg::DesiredTrajectory>(topics::kDesiredTrajectory, [&](const msg::DesiredTrajectory& desired) {
    if (std::string(desired.motion) != "travel" || compared) return;
    compared = true;
    EXPECT_EQ(desired.point_count, 3);
    EXPECT_TRUE(has_valid_path(desired));
    const double begin_m = X_MH.p.x();  // the place on the first line beside the head
    for (const auto& [arc_m, x_m, y_m] : {std::tuple{0.0, begin_m, 0.0},
                                          {1.0 - begin_m, 1.0, 0.0},
                                          {1.0 - begin_m + std::sqrt(0.125), 1.25, 0.25},
                                          {1.0 - begin_m + std::sqrt(0.5) + 1.0, 1.5, 1.5}}) {
      const Eigen::Vector2d p_M = X_MH.to_parent(pose_at(desired, arc_m).p);
      EXPECT_NEAR(p_M.x(), x_m, 0.01) << arc_m;
      EXPECT_NEAR(p_M.y(), y_m, 0.01) << arc_m;
    }
  });
  r.run.advance(30);
  EXPECT_TRUE(compared);
}

TEST(FollowPath, TheErrorIsNaNWithoutAGoal) {
  PathRun r(msg::TaskCommand{});
  r.run.advance(5);
  EXPECT_TRUE(std::isnan(r.run.latest(topics::kTaskStatus)->cross_track_m));
}

TEST(FollowPath, RefusesPathsThatAreTooShortOrTooFarAway) {
  for (const auto& path : std::vector<std::vector<Point>>{{}, {{0, 0}}, {{0, 0}, {0, 0}, {1, 0}}, {{5, 5}, {6, 5}}}) {
    PathRun r(testing::follow_path_command(path));
    r.run.advance(20);
    EXPECT_EQ(r.last_state(), msg::kGoalRefused) << path.size();
  }
}

TEST(FollowPath, ContinuesIdenticallyAfterARestart) {
  PathRun whole(testing::follow_path_command(kPath));
  PathRun broken(testing::follow_path_command(kPath));
  whole.run.advance(400);
  broken.run.advance(177);
  broken.run.restart("navigation");
  broken.run.advance(223);
  EXPECT_EQ(whole.run.output_hashes().at("navigation"), broken.run.output_hashes().at("navigation"));
}

}  // namespace
}  // namespace constrictor
