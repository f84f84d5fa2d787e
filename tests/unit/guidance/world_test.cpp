// Dead reckoning compared with the simulated physics: inertia, slip, sensor noise, and grounds that the robot does not
// know.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "component/data_path.hpp"
#include "guidance/guidance_config.hpp"
#include "guidance/odometry.hpp"
#include "guidance/pose_filter.hpp"
#include "robot/planar.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor {
namespace {

using namespace guidance;

const OdometryConfig kConfig = GuidanceConfig{}.odometry;

struct Case {
  const char* name;
  OpenLoopGait gait;
  double friction_along = 0.05, friction_across = 0.5;
  double grade = 0.0, uphill_rad = 0.0;  ///< slope of the ground, relative to the first heading
  bool imu = true;                       ///< the yaw is measured
};

double yaw_of(const Eigen::Isometry3d& pose) { return std::atan2(pose.linear()(1, 0), pose.linear()(0, 0)); }

class DeadReckoning : public ::testing::TestWithParam<Case> {};

TEST_P(DeadReckoning, StaysWithinSixPercentOfTheDistanceOnUnknownGround) {
  const Case& c = GetParam();
  const RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  Scenario scenario;
  const double angle_rad = std::atan(c.grade);
  const Eigen::Vector3d uphill(std::cos(c.uphill_rad), std::sin(c.uphill_rad), 0.0);
  scenario.gravity_m_s2 = -9.81 * (std::sin(angle_rad) * uphill + std::cos(angle_rad) * Eigen::Vector3d::UnitZ());
  RobotModel on_ground = robot;
  on_ground.friction_along = c.friction_along;
  on_ground.friction_across = c.friction_across;
  World world(on_ground, scenario);
  RobotModel blind = robot;  // guidance must not read the friction of the robot file
  blind.friction_along = blind.friction_across = std::nan("");
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;

  const double dt = 0.02;
  OdometryState state;
  PoseFilterState filter_state;
  PoseFilter filter(filter_state);
  const Eigen::Isometry3d start = world.module_pose(0);
  double path_m = 0.0, drift_rad = 0.0;
  Eigen::Vector3d last = start.translation();
  for (int k = 0; path_m < 5.0 && k < 1500; ++k) {
    std::vector<double> q(robot.joints.size()), rate(q.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = world.joint_angle_rad(i) + robot.joint_position_noise_rad * normal(random);
      rate[i] = world.joint_rate_rad_s(i);
    }
    drift_rad += robot.imu_yaw_drift_rad_sqrt_s * std::sqrt(dt) * normal(random);
    OdometryInput input;
    input.joint_rad = q.data();
    input.joint_rad_s = rate.data();
    if (c.imu) input.yaw_rad = wrap_angle(yaw_of(world.module_pose(0)) - yaw_of(start) + drift_rad);
    else input.yaw_rad = std::nan("");
    input.ground.assign(robot.module_count, {0.0, 0.0, 0.0});
    for (const ModuleContact& contact : world.contacts()) {
      Eigen::Vector3d force = contact.force_n;
      for (double& each : force) each += robot.contact_force_noise_n * normal(random);
      GroundForce& ground = input.ground[contact.module_index];
      ground = {ground.along_n + force.x(), ground.across_n + force.y(), ground.normal_n + force.z()};
    }
    for (const GroundForce& ground : input.ground) input.load_n.push_back(ground.normal_n);
    const Eigen::Vector3d g = world.module_pose(0).linear().transpose() * scenario.gravity_m_s2 / 9.81;
    input.downhill = g.head<2>();
    if (k == 0) input.load_n.clear();  // no contact has been measured yet
    const HeadStep step = advance_odometry(state, blind, kConfig, input);
    filter.predict(step.step_m, step.turn_rad, Eigen::Matrix3d::Zero());
    path_m += (world.module_pose(0).translation() - last).norm();
    last = world.module_pose(0).translation();
    c.gait.drive(world, k * dt, dt);
  }
  ASSERT_GE(path_m, 5.0);
  // The last drive() was one period after the last estimate.
  const PlanarPose origin{{start.translation().x(), start.translation().y()}, yaw_of(start)};
  const Eigen::Vector2d truth = origin.to_local(last.head<2>());
  const double error_m = (filter.pose().p - truth).norm();
  std::printf("%s: %.2f m, error %.3f m (%.1f %%), yaw drift %.2f degrees\n", c.name, path_m, error_m,
              100.0 * error_m / path_m, std::abs(drift_rad) * 180.0 / std::numbers::pi);
  const double yaw_error_rad = wrap_angle(yaw_of(world.module_pose(0)) - yaw_of(start) - filter.pose().yaw_rad);
  std::printf("  yaw error %.2f degrees\n", yaw_error_rad * 180.0 / std::numbers::pi);
  std::printf("  friction along %.3f (true %.3f), across %.3f (true %.3f)\n", state.friction_along, c.friction_along,
              state.friction_across, c.friction_across);
  EXPECT_NEAR(state.friction_along, c.friction_along, 0.2 * c.friction_along + 0.005);
  EXPECT_NEAR(state.friction_across, c.friction_across, 0.2 * c.friction_across);
  EXPECT_LT(error_m, 0.06 * path_m);
  EXPECT_LT(std::abs(yaw_error_rad), 0.05);
}

INSTANTIATE_TEST_SUITE_P(
    Gaits, DeadReckoning,
    ::testing::Values(Case{"straight", {}}, Case{"left on slippery ground", {0.5, 0.7, 1.07, 0.8}, 0.04, 0.4},
                      Case{"backwards", {0.5, -0.7, 1.07, 0.0}},
                      Case{"slowly right on rough ground", {0.4, 0.6, 1.07, -0.4}, 0.06, 0.6},
                      Case{"creeping", {0.35, 0.4, 1.07, 0.0}}, Case{"half the ratio", {}, 0.1, 0.5},
                      Case{"twice the ratio", {}, 0.025, 0.5}, Case{"twice the friction", {}, 0.1, 1.0},
                      Case{"across a slope", {}, 0.05, 0.5, 0.03, 1.57}, Case{"uphill", {}, 0.05, 0.5, 0.03, 0.0},
                      Case{"backwards across a slope", {0.5, -0.7, 1.07, 0.0}, 0.05, 0.5, 0.04, -1.57},
                      Case{"in a curve on a slope", {0.6, 1.1, 1.07, 0.5}, 0.05, 0.5, 0.03, 2.0},
                      Case{"straight without inertial unit", {}, 0.05, 0.5, 0.0, 0.0, false},
                      Case{"left without inertial unit", {0.5, 0.7, 1.07, 0.8}, 0.05, 0.5, 0.0, 0.0, false},
                      Case{"backwards without inertial unit", {0.5, -0.7, 1.07, 0.0}, 0.04, 0.4, 0.0, 0.0, false}),
    [](const auto& parameter) { return "Gait" + std::to_string(parameter.index); });

}  // namespace
}  // namespace constrictor
