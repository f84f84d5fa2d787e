// Direct motions: the trajectories that they ask for, and how they and tasks end each other.
#include "navigation/direct_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "barrier/local_run.hpp"
#include "navigation/navigation.hpp"
#include "support/project.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

class DirectMotion : public ::testing::Test {
 protected:
  TaskOutput ask(std::uint8_t motion, double speed_m_s = 0.0, double curvature_1_m = 0.0, double angle_rad = 0.0) {
    msg::MotionCommand command{};
    command.motion = motion;
    command.speed_m_s = speed_m_s;
    command.curvature_1_m = curvature_1_m;
    command.angle_rad = angle_rad;
    begin_motion(command, state_, grip_);
    return step();
  }
  TaskOutput step() {
    TaskOutput output;
    step_motion(config_, sense_, grip_, state_, output);
    return output;
  }
  RobotModel robot_ = load_robot(testing::robot_path("mamba"));
  NavigationConfig config_;
  GripSense sense_{robot_, config_.grip};
  Grip grip_;
  DirectMotionState state_;
};

TEST_F(DirectMotion, DrivesForwardsBackwardsAndInCurves) {
  EXPECT_EQ(ask(msg::kMotionDrive, 0.5, 0.8).desired.speed_m_s, 0.5);
  EXPECT_EQ(step().desired.points[0].curvature_1_m, 0.8);
  const TaskOutput back = ask(msg::kMotionDrive, -0.5);
  EXPECT_EQ(back.desired.speed_m_s, -0.5);
  EXPECT_FALSE(back.new_motion) << "another speed continues the same motion";
  EXPECT_STREQ(back.desired.motion, "travel");
}

TEST_F(DirectMotion, LooksLeftWithThePositiveSign) {
  const TaskOutput look = ask(msg::kMotionLook, 0.0, 0.0, 0.6);
  EXPECT_STREQ(look.desired.motion, "bend");
  double sum_rad = 0.0;
  for (int k = 0; k < look.desired.shape_count; ++k) sum_rad += look.desired.shape_rad[k];
  EXPECT_NEAR(sum_rad, 0.6, 1e-12);
}

TEST_F(DirectMotion, WrapsToTheSideOfTheSignAndDrivesWrapped) {
  const TaskOutput wrap = ask(msg::kMotionWrap, 0.0, 0.0, -1.0);
  EXPECT_STREQ(wrap.desired.motion, "wrap");
  EXPECT_GT(wrap.desired.slide_m_s, 0.0);
  EXPECT_LT(wrap.desired.shape_rad[5], -0.5);
  const TaskOutput drive = ask(msg::kMotionDrive, 0.5);
  EXPECT_LT(drive.desired.shape_rad[5], -0.5);
  ask(msg::kMotionOpen);
  EXPECT_EQ(ask(msg::kMotionDrive, 0.5).desired.shape_count, 0);
}

TEST_F(DirectMotion, SqueezesOnlyAWrappedBodyAndCapsTheTorque) {
  EXPECT_STREQ(ask(msg::kMotionSqueeze).desired.motion, "stand");
  ask(msg::kMotionWrap, 0.0, 0.0, 1.0);
  const TaskOutput squeeze = ask(msg::kMotionSqueeze);
  EXPECT_STREQ(squeeze.desired.motion, "squeeze");
  EXPECT_TRUE(squeeze.new_motion);
  EXPECT_FALSE(step().new_motion);
  EXPECT_GT(squeeze.desired.torque_limit_nm, 0.0);
  const TaskOutput stand = ask(msg::kMotionStand);
  EXPECT_STREQ(stand.desired.motion, "stand");
  EXPECT_EQ(stand.desired.torque_limit_nm, config_.grip.hold_torque_nm);
}

TEST_F(DirectMotion, OpeningReleasesAnObjectThatATaskGrasped) {
  grip_.carrying = true;
  grip_.shape_rad[5] = 1.0;
  EXPECT_GT(ask(msg::kMotionDrive, 0.5).desired.shape_rad[5], 0.9);
  ask(msg::kMotionOpen);
  EXPECT_FALSE(grip_.carrying);
  EXPECT_EQ(step().desired.shape_rad[5], 0.0);
}

/// Stands for the component `input`: rotate at tick 10, drive at 20, rotate at 30, drive at 40, stand at 50.
ComponentFactory scripted_input() {
  return testing::scripted_member("input", [](Wiring& wiring) -> testing::StepFunction {
    return
        [task = wiring.output(topics::kTaskCommand), motion = wiring.output(topics::kMotionCommand)](const Tick& tick) {
          if (tick.index == 10 || tick.index == 30) {
            msg::TaskCommand command{};
            command.goal_id = static_cast<std::uint64_t>(tick.index);
            command.task = msg::kTaskRotate;
            command.parameters.direction = msg::kDirectionLeft;
            command.parameters.timeout_s = std::nan("");
            task.write(command);
          }
          if (tick.index == 20 || tick.index == 40 || tick.index == 50) {
            msg::MotionCommand command{};
            command.motion = tick.index == 50 ? msg::kMotionStand : msg::kMotionDrive;
            command.speed_m_s = 0.4;
            motion.write(command);
          }
        };
  });
}

LocalRun make_run() {
  Setup setup;
  setup.robot_file = testing::robot_path("mamba");
  return LocalRun(
      {testing::still_robot(), make_navigation_factory(),
       testing::scripted_writer<msg::RobotPose>("guidance", topics::kRobotPose,
                                                [](const Tick&, const auto& out) { out.write(msg::RobotPose{}); }),
       scripted_input()},
      setup);
}

TEST(DirectMotionInNavigation, TasksAndMotionsEndEachOther) {
  LocalRun run = make_run();
  std::map<std::uint64_t, int> preempted;
  run.subscribe<msg::TaskEvent>(topics::kTaskEvent, [&](const msg::TaskEvent& e) {
    preempted[e.goal_id] += e.goal_state == msg::kGoalPreempted;
  });
  const auto speed_m_s = [&](std::int64_t tick) {
    run.advance(tick - run.tick());
    return run.latest(topics::kDesiredTrajectory)->speed_m_s;
  };
  EXPECT_NE(speed_m_s(15), 0.4);
  EXPECT_EQ(speed_m_s(25), 0.4);
  EXPECT_EQ(preempted[10], 1);
  EXPECT_NE(speed_m_s(35), 0.4);
  EXPECT_EQ(speed_m_s(45), 0.4);
  EXPECT_EQ(preempted[30], 1);
  speed_m_s(55);
  EXPECT_STREQ(run.latest(topics::kDesiredTrajectory)->motion, "stand");
}

TEST(DirectMotionInNavigation, ContinuesIdenticallyAfterARestart) {
  LocalRun whole = make_run();
  LocalRun broken = make_run();
  whole.advance(60);
  broken.advance(23);
  broken.restart("navigation");
  broken.advance(37);
  EXPECT_EQ(whole.output_hashes().at("navigation"), broken.output_hashes().at("navigation"));
}

}  // namespace
}  // namespace constrictor
