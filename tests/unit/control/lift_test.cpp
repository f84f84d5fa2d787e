// The base of a U rises from the ground while the body moves. The heights of the modules follow from the robot's
// kinematics in space; control knows the body from above only.
#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <string>

#include "robot/kinematics.hpp"
#include "unit/control/control_run.hpp"

namespace constrictor {
namespace {

constexpr int kFirstOfBase = 11, kLastOfBase = 14;  // modules between the three base joints of set_u()
constexpr int kFormed_ticks = 300;                  // the U has been formed, and the base has risen

/// [m] height of each module's centre over that of the head, which lies level.
std::vector<double> heights_m(const RobotModel& robot, const double* joint_rad) {
  std::vector<double> heights;
  for (const auto& pose : module_poses(robot, std::span(joint_rad, robot.joints.size())))
    heights.push_back(pose.translation().z());
  return heights;
}

/// The body drives with this motion; after `lift_ticks` it delivers, with the base on the ground.
LocalRun run_of_u(const std::string& motion, double speed_m_s, int lift_ticks = 1000000) {
  return make_run([=](const Tick& tick, msg::DesiredTrajectory& desired) {
    const bool delivers = tick.index > lift_ticks;
    set_motion(desired, delivers ? "deliver" : motion.c_str(), delivers ? 2 : 1);
    desired.speed_m_s = speed_m_s;
    set_u(desired);
    return true;
  });
}

/// [m] mean heights over three seconds, several periods of the wave: the wave turns the hinges a little to and fro.
std::vector<double> heights_after(LocalRun& run, int ticks) {
  constexpr int kMean_ticks = 150;
  const RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  run.advance(ticks);
  std::vector<double> mean(robot.module_count, 0.0);
  for (int tick = 0; tick < kMean_ticks; ++tick) {
    run.advance(1);
    const auto z_m = heights_m(robot, run.latest(topics::kJointCommand)->position_rad);
    for (std::size_t m = 0; m < mean.size(); ++m) mean[m] += z_m[m] / kMean_ticks;
  }
  return mean;
}

TEST(Lift, RaisesTheBaseAndLeavesTheArmsOnTheGround) {
  for (const char* motion : {"carry", "seat", "leave"}) {
    LocalRun run = run_of_u(motion, 0.1);
    const auto z_m = heights_after(run, kFormed_ticks);
    for (int m = 0; m < static_cast<int>(z_m.size()); ++m) {
      if (m >= kFirstOfBase && m <= kLastOfBase) {
        EXPECT_GT(z_m[m], 0.0003) << motion << ", module " << m;
        EXPECT_LT(z_m[m], 0.003) << motion << ", module " << m;
      } else if (m < kFirstOfBase - 1 || m > kLastOfBase + 1) {
        EXPECT_NEAR(z_m[m], 0.0, 0.0003) << motion << ", module " << m;
      }
    }
  }
}

TEST(Lift, KeepsTheBaseOnTheGroundWhereTheRobotMustNotDrift) {
  for (const char* motion : {"deliver", "squeeze"}) {
    LocalRun run = run_of_u(motion, 0.1);
    for (const double z_m : heights_after(run, kFormed_ticks)) EXPECT_EQ(z_m, 0.0) << motion;
  }
}

TEST(Lift, AShortArmDoesNotCarryTheBase) {
  for (const int towards_tail : {0, 1, 2}) {
    LocalRun run = make_run([=](const Tick&, msg::DesiredTrajectory& desired) {
      set_motion(desired, "carry", 1);
      desired.speed_m_s = 0.1;
      desired.shape_count = 12;
      for (int k = 5; k <= 7; ++k) desired.shape_rad[k + towards_tail] = 1.047;
      return true;
    });
    const auto z_m = heights_after(run, kFormed_ticks);
    const double highest_m = *std::max_element(z_m.begin(), z_m.end());
    if (towards_tail < 2) EXPECT_GT(highest_m, 0.0003) << towards_tail;
    else EXPECT_EQ(highest_m, 0.0) << "the rear arm has five modules, 0.45 m";
  }
}

TEST(Lift, ABodyThatDoesNotMoveIsNotRaised) {
  LocalRun run = run_of_u("carry", 0.0);
  for (const double z_m : heights_after(run, kFormed_ticks)) EXPECT_EQ(z_m, 0.0);
}

TEST(Lift, RisesAndFallsWithoutAJump) {
  LocalRun run = run_of_u("seat", 0.15, kFormed_ticks);
  run.advance(1);
  const RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  double highest_rad = 0.0;
  auto before = *run.latest(topics::kJointCommand);
  for (int tick = 0; tick < 2 * kFormed_ticks; ++tick) {
    run.advance(1);
    const auto now = *run.latest(topics::kJointCommand);
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      if (robot.joints[j].axis != JointAxis::kPitch) continue;
      EXPECT_LE(std::abs(now.position_rad[j] - before.position_rad[j]), 0.0011) << "joint " << j << ", tick " << tick;
      highest_rad = std::max(highest_rad, std::abs(now.position_rad[j]));
    }
    before = now;
  }
  EXPECT_DOUBLE_EQ(highest_rad, ControlConfig().lift_rad);
  for (const double z_m : heights_m(robot, before.position_rad)) EXPECT_NEAR(z_m, 0.0, 1e-12) << "it delivers";
}

}  // namespace
}  // namespace constrictor
