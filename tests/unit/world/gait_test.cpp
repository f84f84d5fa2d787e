// The open-loop gait reaches the speeds and radii of the preceding study, and those of a short step.
#include <gtest/gtest.h>

#include "unit/world/world_fixture.hpp"

namespace constrictor {
namespace {

class GaitOfTheStudy : public EachEngine {};
INSTANTIATE_TEST_SUITE_P(Engines, GaitOfTheStudy, kEngines, engine_name);

class Servos : public EachEngine {};
INSTANTIATE_TEST_SUITE_P(Engines, Servos, kEngines, engine_name);

struct Course {
  double speed_m_s;   ///< of the mean position of the body, along the initial heading
  double turn_rad_s;  ///< of the head
  double drift_m;     ///< sideways from the initial heading
  double radius_m;    ///< distance travelled for each radian of turn
};

Course run(const OpenLoopGait& gait, const SolverSettings& settings, double heading_rad = 0.0) {
  Scenario scenario;
  scenario.start_yaw_rad = heading_rad;
  World world(mamba(), scenario, settings);
  const auto centre = [&] {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < world.module_count(); ++i) sum += world.module_pose(i).translation();
    return Eigen::Vector3d(sum / static_cast<double>(world.module_count()));
  };
  const double settle_s = 3.0;
  const int cycles = 4;
  const double measured_s = cycles / std::abs(gait.frequency_hz);
  double time_s = 0.0;
  for (; time_s < settle_s; time_s += kPeriod_s) gait.drive(world, time_s, kPeriod_s);
  const Eigen::Vector3d from = centre();
  double yaw = 0.0;
  double path_m = 0.0;
  double before = std::atan2(world.module_pose(0).linear()(1, 0), world.module_pose(0).linear()(0, 0));
  Eigen::Vector3d previous = from;
  const double until_s = time_s + measured_s;
  for (; time_s < until_s; time_s += kPeriod_s) {
    gait.drive(world, time_s, kPeriod_s);
    const Eigen::Matrix3d R = world.module_pose(0).linear();
    const double now = std::atan2(R(1, 0), R(0, 0));
    yaw += std::remainder(now - before, 2.0 * std::numbers::pi);
    before = now;
    path_m += (centre() - previous).norm();
    previous = centre();
  }
  const Eigen::Vector3d moved = Eigen::AngleAxisd(-heading_rad, Eigen::Vector3d::UnitZ()) * (centre() - from);
  return {moved.x() / measured_s, yaw / measured_s, moved.y(), path_m / std::abs(yaw)};
}

/// The course with a step of 0.5 ms.
Course fine_course(const OpenLoopGait& gait) {
  SolverSettings fine;
  fine.engine = kEngineChain;
  fine.step_s = 0.0005;
  return run(gait, fine);
}

OpenLoopGait curved(double curvature_1_m) {
  OpenLoopGait gait;
  gait.curvature_1_m = curvature_1_m;
  return gait;
}

TEST_P(GaitOfTheStudy, DrivesStraightAtTheStudysSpeed) {
  const Course course = run({}, settings());
  const Course converged = fine_course({});
  EXPECT_NEAR(course.speed_m_s, converged.speed_m_s, 0.03 * converged.speed_m_s);
  EXPECT_GT(course.speed_m_s, 0.6);
  EXPECT_LT(course.speed_m_s, 0.95);
  const double way_m = converged.speed_m_s * 4 / OpenLoopGait{}.frequency_hz;
  EXPECT_NEAR(course.drift_m, converged.drift_m, 0.03 * way_m);
}

TEST_P(GaitOfTheStudy, DrivesBackwardsAtTheStudysSpeed) {
  OpenLoopGait gait;
  gait.frequency_hz = -0.7;
  const double speed_m_s = run(gait, settings()).speed_m_s;
  EXPECT_NEAR(speed_m_s, -0.63, 0.03 * 0.63);
  EXPECT_NEAR(speed_m_s, fine_course(gait).speed_m_s, 0.03 * 0.63);
}

TEST_P(GaitOfTheStudy, TurnsWithTheStudysRadius) {
  const Course course = run(curved(0.8), settings());
  const Course converged = fine_course(curved(0.8));
  EXPECT_NEAR(course.turn_rad_s, converged.turn_rad_s, 0.03 * converged.turn_rad_s);
  EXPECT_NEAR(course.radius_m, converged.radius_m, 0.03 * converged.radius_m);
  EXPECT_GT(course.turn_rad_s, 0.3);
  EXPECT_NEAR(course.radius_m, 1.1, 0.1);
}

TEST_P(GaitOfTheStudy, RotatesAlmostOnTheSpotWithStrongCurvature) {
  const Course course = run(curved(-2.2), settings());
  const Course converged = fine_course(curved(-2.2));
  EXPECT_NEAR(course.turn_rad_s, converged.turn_rad_s, -0.03 * converged.turn_rad_s);
  EXPECT_NEAR(course.radius_m, converged.radius_m, 0.03 * converged.radius_m);
  EXPECT_LT(course.turn_rad_s, -66 * std::numbers::pi / 180);
  EXPECT_LT(course.radius_m, 0.3);
}

// A curve to the left is the mirror image of the curve to the right, half an undulation later.
TEST_P(GaitOfTheStudy, CurvesToBothSidesAlike) {
  for (const double curvature_1_m : {0.8, 2.2}) {
    const Course left = run(curved(curvature_1_m), settings());
    const Course right = run(curved(-curvature_1_m), settings());
    EXPECT_GT(left.turn_rad_s, 0.0);
    EXPECT_NEAR(right.turn_rad_s, -left.turn_rad_s, 0.02 * left.turn_rad_s) << curvature_1_m;
    EXPECT_NEAR(right.radius_m, left.radius_m, 0.02 * left.radius_m) << curvature_1_m;
  }
}

// Nothing on a level ground distinguishes the axes of the world.
TEST_P(GaitOfTheStudy, DoesNotDependOnTheHeading) {
  const Course ahead = run(curved(0.8), settings());
  for (const double heading_rad : {0.3, 0.25 * std::numbers::pi, 0.5 * std::numbers::pi}) {
    const Course turned = run(curved(0.8), settings(), heading_rad);
    EXPECT_NEAR(turned.turn_rad_s, ahead.turn_rad_s, 0.02 * ahead.turn_rad_s) << heading_rad;
    EXPECT_NEAR(turned.radius_m, ahead.radius_m, 0.02 * ahead.radius_m) << heading_rad;
  }
}

/// How well the servos of the yaw joints do their work in a steady gait.
struct ServoWork {
  double tracking_rad;  ///< rms of setpoint minus angle at the end of each tick
  double ripple_nm;     ///< rms of the torque about its mean in each tick
  double work_j;        ///< of all joints
  double friction_j;    ///< taken by all contacts
};

ServoWork run_servos(const OpenLoopGait& gait, double period_s, const SolverSettings& settings) {
  const RobotModel robot = mamba();
  World world(robot, Scenario{}, settings);
  ServoWork servos{};
  double error = 0.0;
  double ripple = 0.0;
  int ticks = 0;
  int steps = 0;
  for (double time_s = 0.0; time_s < 3.0 + 4.0 / gait.frequency_hz; time_s += period_s) {
    const bool measured = time_s > 3.0;
    std::vector<std::vector<double>> torques(world.joint_count());
    std::vector<double> rates(world.joint_count());
    for (std::size_t i = 0; i < rates.size(); ++i) rates[i] = world.joint_rate_rad_s(i);
    gait.drive(world, time_s, period_s, [&] {
      if (!measured) return;
      for (std::size_t i = 0; i < rates.size(); ++i) {
        torques[i].push_back(world.joint(i).step_torque_nm());
        const double rate = 0.5 * (rates[i] + world.joint_rate_rad_s(i));  // the work of a step is exact with the mean
        servos.work_j += settings.step_s * world.joint(i).step_torque_nm() * rate;
        rates[i] = world.joint_rate_rad_s(i);
      }
      servos.friction_j -= settings.step_s * world.contact_power_w();
    });
    if (!measured) continue;
    const std::vector<double> setpoint = gait.angles(robot, time_s + period_s);
    for (const std::size_t joint : robot.yaw_joints()) {
      double mean = 0.0;
      for (const double torque : torques[joint]) mean += torque / static_cast<double>(torques[joint].size());
      for (const double torque : torques[joint]) ripple += (torque - mean) * (torque - mean);
      steps += static_cast<int>(torques[joint].size());
      error += std::pow(setpoint[joint] - world.joint_angle_rad(joint), 2);
      ++ticks;
    }
  }
  servos.tracking_rad = std::sqrt(error / ticks);
  servos.ripple_nm = std::sqrt(ripple / steps);
  return servos;
}

TEST_P(Servos, FollowTheGaitWithoutRipple) {
  for (const double period_s : {0.02, 0.04}) {  // the ripple must not grow with the jump of the setpoint
    const ServoWork servos = run_servos({}, period_s, settings());
    EXPECT_LT(servos.tracking_rad, 0.005) << period_s;
    EXPECT_LT(servos.ripple_nm, 0.3) << period_s;
  }
}

// The torque of a setpoint that jumps grows when the steps become finer.
TEST(ServosWithFineSteps, HaveNoRipple) {
  SolverSettings fine;
  fine.step_s = 0.0005;
  const ServoWork servos = run_servos({}, kPeriod_s, fine);
  EXPECT_LT(servos.ripple_nm, 0.3);
  EXPECT_LT(servos.tracking_rad, 0.005);
}

TEST_P(Servos, DoTheWorkThatFrictionTakes) {
  const ServoWork servos = run_servos({}, kPeriod_s, settings());
  EXPECT_GT(servos.work_j, 1.0);
  EXPECT_NEAR(servos.work_j, servos.friction_j, 0.01 * servos.work_j);
}

}  // namespace
}  // namespace constrictor
