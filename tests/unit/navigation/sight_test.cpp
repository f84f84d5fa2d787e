// What navigation does when perception falls silent: a dead camera must not let the robot drive on.
#include <gtest/gtest.h>

#include <limits>

#include "barrier/local_run.hpp"
#include "navigation/navigation.hpp"
#include "support/project.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

constexpr std::int64_t kSilentFrom = 200;
constexpr std::int64_t kSilentUntil = 400;

/// A line straight ahead, in each fifth tick except while perception is silent.
ComponentFactory perception(bool ever) {
  return testing::scripted_writer<msg::LinePercept>(
      "perception", topics::kLinePercept, [ever](const Tick& tick, const auto& out) {
        if (!ever || tick.index % 5 != 0 || (tick.index >= kSilentFrom && tick.index < kSilentUntil)) return;
        msg::LinePercept line{};
        line.exposure_tick = tick.index;
        line.visible = true;
        line.colour = msg::kColourBlue;
        line.point_count = 2;
        line.x_m[0] = 0.2;
        line.x_m[1] = 1.0;
        out.write(line);
      });
}

ComponentFactory pose() {
  return testing::scripted_writer<msg::RobotPose>("guidance", topics::kRobotPose,
                                                  [](const Tick&, const auto& out) { out.write(msg::RobotPose{}); });
}

ComponentFactory command(std::uint8_t task) {
  return testing::scripted_writer<msg::TaskCommand>(
      "input", topics::kTaskCommand, [task](const Tick& tick, const auto& out) {
        if (tick.index != 10) return;
        msg::TaskCommand start{};
        start.goal_id = 1;
        start.task = task;
        start.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
        start.parameters.line_colour = msg::kColourBlue;
        start.parameters.direction = msg::kDirectionLeft;
        start.path.point_count = 2;
        start.path.x_m[1] = 5.0;
        out.write(start);
      });
}

class SightRun {
 public:
  explicit SightRun(std::uint8_t task, bool camera = true) {
    Setup setup;
    setup.robot_file = testing::robot_path("mamba");
    run_ = std::make_unique<LocalRun>(std::vector<ComponentFactory>{testing::still_robot(), perception(camera),
                                                                    make_navigation_factory(), pose(), command(task)},
                                      setup);
  }
  /// The kind of motion that navigation asks for at this tick.
  std::string motion_at(std::int64_t tick) {
    run_->advance(tick - tick_);
    tick_ = tick;
    return run_->latest(topics::kDesiredTrajectory)->motion;
  }
  std::string phase() { return run_->latest(topics::kTaskStatus)->phase; }
  std::uint8_t goal_state() { return run_->latest(topics::kTaskStatus)->goal_state; }

 private:
  std::unique_ptr<LocalRun> run_;
  std::int64_t tick_ = 0;
};

TEST(Sight, WithoutPerceptsATaskThatSteersBySightStandsUntilTheyComeAgain) {
  for (const std::uint8_t task : {msg::kTaskFollowLine, msg::kTaskRotate, msg::kTaskExplore}) {
    SightRun run(task);
    EXPECT_NE(run.motion_at(kSilentFrom + 60), "stand") << "a few lost images change nothing";
    EXPECT_EQ(run.motion_at(kSilentFrom + 100), "stand");
    EXPECT_EQ(run.phase(), "blind");
    EXPECT_EQ(run.motion_at(kSilentUntil), "stand");
    EXPECT_EQ(run.goal_state(), msg::kGoalRunning) << "the task waits";
    EXPECT_NE(run.motion_at(kSilentUntil + 10), "stand");
    EXPECT_NE(run.phase(), "blind");
  }
}

TEST(Sight, ATaskThatNeedsNoSightGoesOn) {
  SightRun run(msg::kTaskFollowPath);
  EXPECT_EQ(run.motion_at(kSilentUntil - 1), "travel");
}

TEST(Sight, ARobotWithoutACameraIsNotBlind) {
  SightRun run(msg::kTaskRotate, false);
  EXPECT_EQ(run.motion_at(kSilentUntil), "travel");
}

}  // namespace
}  // namespace constrictor
