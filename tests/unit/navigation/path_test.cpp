// follow_path: a point that drives as the curvature says comes to the path's end, and the reported cross-track error is its distance
// from the path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "navigation/navigation.hpp"
#include "runtime/local_run.hpp"

namespace constrictor {
namespace {

struct Point {
  double x_m, y_m;
};
/// An S-curve of radius 1.25 m by points 0.25 m apart.
std::vector<Point> s_curve() {
  std::vector<Point> path{{0, 0}};
  double yaw_rad = 0;
  for (int i = 0; i < 20; ++i) {
    path.push_back({path.back().x_m + 0.25 * std::cos(yaw_rad), path.back().y_m + 0.25 * std::sin(yaw_rad)});
    yaw_rad += i < 3 ? 0.0 : i < 9 ? 0.2 : i < 17 ? -0.2 : 0.0;
  }
  return path;
}
const std::vector<Point> kPath = s_curve();
constexpr double kSpeed_m_s = 0.4;

msg::TaskCommand follow(const std::vector<Point>& path) {
  msg::TaskCommand command{};
  command.goal_id = 1;
  command.task = msg::kTaskFollowPath;
  command.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
  command.path.point_count = static_cast<std::uint16_t>(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    command.path.x_m[i] = path[i].x_m;
    command.path.y_m[i] = path[i].y_m;
  }
  return command;
}

/// Distance of a point from a polyline, by trying many points of it.
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

class StillJoints : public Plant {
 public:
  explicit StillJoints(Wiring& wiring) : joints_(wiring.output(topics::kJointState)), contacts_(wiring.output(topics::kContactState)) {}
  void sample(const Tick&) override {
    msg::JointState joints{};
    joints.joint_count = 23;
    joints_.write(joints);
    contacts_.write(msg::ContactState{});
  }
  void step(const Tick&) override {}
  [[nodiscard]] std::int64_t period_ns() const override { return 20'000'000; }

 private:
  Output<msg::JointState> joints_;
  Output<msg::ContactState> contacts_;
};

struct Driven {
  double x_m = 0, y_m = 0.1, yaw_rad = 0.2;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(x_m, y_m, yaw_rad);
  }
};

/// A point on the plane that moves on by the curvature that navigation wants: the pose that guidance would estimate.
class DrivenPoint : public StatefulComponent<Driven> {
 public:
  explicit DrivenPoint(Wiring& wiring) : out_(wiring.output(topics::kRobotPose)), desired_(wiring.latest(topics::kDesiredTrajectory)) {}
  void step(const Tick& tick) override {
    if (desired_ && std::string(desired_->method) == "undulation") {
      const double step_m = kSpeed_m_s * tick.dt_s();
      state_.yaw_rad += desired_->curvature_1_m * step_m;
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

class OneCommand : public StatefulComponent<int> {
 public:
  OneCommand(Wiring& wiring, const msg::TaskCommand& command) : out_(wiring.output(topics::kTaskCommand)), command_(command) {}
  void step(const Tick& tick) override {
    if (tick.index == 10) out_.write(command_);
  }

 private:
  Output<msg::TaskCommand> out_;
  msg::TaskCommand command_;
};

struct PathRun {
  std::vector<msg::TaskEvent> events;
  LocalRun run;
  explicit PathRun(const msg::TaskCommand& command)
      : run({{"physics", [](Wiring& w, const Setup&) { return std::make_unique<StillJoints>(w); }},
             make_navigation_factory(),
             {"guidance", [](Wiring& w, const Setup&) { return std::make_unique<DrivenPoint>(w); }},
             {"input", [command](Wiring& w, const Setup&) { return std::make_unique<OneCommand>(w, command); }}},
            setup()) {
    run.subscribe<msg::TaskEvent>(topics::kTaskEvent, [this](const msg::TaskEvent& event) { events.push_back(event); });
  }
  static Setup setup() {
    Setup setup;
    setup.robot_file = SOURCE_DIR "/components/robot/mamba.yaml";
    return setup;
  }
  [[nodiscard]] std::uint8_t last_state() const { return events.empty() ? msg::kGoalIdle : events.back().goal_state; }
};

TEST(FollowPath, DrivesToTheLastPointAndReportsItsDistanceFromThePath) {
  PathRun r(follow(kPath));
  std::vector<Point> poses{{0, 0.1}};  // by tick
  r.run.subscribe<msg::RobotPose>(topics::kRobotPose, [&](const msg::RobotPose& pose) { poses.push_back({pose.x_m, pose.y_m}); });
  double squares = 0;
  int count = 0;
  r.run.subscribe<msg::TaskStatus>(topics::kTaskStatus, [&](const msg::TaskStatus& status) {
    if (status.state != msg::kGoalRunning || !std::isfinite(status.cross_track_m)) return;
    const Point& seen = poses[static_cast<std::size_t>(status.header.tick)];  // the pose written one tick before
    EXPECT_NEAR(std::abs(status.cross_track_m), distance_m(kPath, seen), 0.03) << seen.x_m << " " << seen.y_m;
    squares += status.cross_track_m * status.cross_track_m;
    ++count;
  });
  r.run.advance(1000);
  EXPECT_EQ(r.last_state(), msg::kGoalSucceeded);
  EXPECT_NEAR(std::hypot(poses.back().x_m - kPath.back().x_m, poses.back().y_m - kPath.back().y_m), 0.1, 0.06);
  ASSERT_GT(count, 400);
  EXPECT_LT(std::sqrt(squares / count), 0.06);  // it begins 0.1 m beside the path
}

TEST(FollowPath, TheErrorIsPositiveToTheLeft) {
  PathRun r(follow({{0, 0}, {3, 0}}));  // the point begins 0.1 m to the left
  r.run.advance(14);
  EXPECT_NEAR(r.run.latest(topics::kTaskStatus)->cross_track_m, 0.1, 0.02);
}

TEST(FollowPath, WithoutAGoalThereIsNoError) {
  PathRun r(msg::TaskCommand{});
  r.run.advance(5);
  EXPECT_TRUE(std::isnan(r.run.latest(topics::kTaskStatus)->cross_track_m));
}

TEST(FollowPath, RefusesPathsThatCannotBeFollowed) {
  for (const auto& path : std::vector<std::vector<Point>>{{}, {{0, 0}}, {{0, 0}, {0, 0}, {1, 0}}, {{5, 5}, {6, 5}}}) {
    PathRun r(follow(path));
    r.run.advance(20);
    EXPECT_EQ(r.last_state(), msg::kGoalRefused) << path.size();
  }
}

TEST(FollowPath, ContinuesIdenticallyAfterARestart) {
  PathRun whole(follow(kPath));
  PathRun broken(follow(kPath));
  whole.run.advance(400);
  broken.run.advance(177);
  broken.run.restart("navigation");
  broken.run.advance(223);
  EXPECT_EQ(whole.run.output_hashes().at("navigation"), broken.run.output_hashes().at("navigation"));
}

}  // namespace
}  // namespace constrictor
