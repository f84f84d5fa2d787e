// Sliding mode control: the model of the inertia compared with a closed form, and the simulated robot that it moves.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "bench/sliding_mode/tracking_trial.hpp"
#include "control/joint_inertia.hpp"
#include "support/project.hpp"

namespace constrictor::sliding_mode {
namespace {

RobotModel mamba() { return load_robot(testing::robot_path("mamba")); }

TEST(JointInertia, OfTwoEqualLinksIsThatOfTheirSymmetricMotion) {
  // Each link turns by half of the angle about its centre, which moves across by d sin(q / 2):
  // T = I q'^2 / 4 + m d^2 sin(q / 2)^2 q'^2 / 4 + J q'^2 / 2 = M q'^2 / 2.
  RobotModel robot = mamba();
  robot.module_count = 2;
  robot.joints.resize(1);
  robot.module_radius_m = 1e-6;  // thin rods: I = m l^2 / 12
  const double m = robot.module_mass_kg, l = robot.module_length_m, d = 0.5 * l;
  for (const double q : {0.0, 0.5, -1.2}) {
    const double expected = 0.5 * m * l * l / 12.0 + 0.5 * m * d * d * std::pow(std::sin(0.5 * q), 2) + 0.01;
    EXPECT_NEAR(JointInertia(robot, {0}).matrix(Eigen::VectorXd::Constant(1, q))(0, 0), expected, 1e-8) << q;
  }
}

TEST(JointInertia, IsSymmetricAndLargerThanThatOfTheRotors) {
  const RobotModel robot = mamba();
  const JointInertia inertia(robot, robot.yaw_joints());
  Eigen::VectorXd angle(12);
  for (int i = 0; i < 12; ++i) angle(i) = 0.4 * std::sin(1.1 * i);
  const Eigen::MatrixXd matrix = inertia.matrix(angle);
  EXPECT_NEAR((matrix - matrix.transpose()).norm(), 0.0, 1e-12);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff(), 0.01);
}

Trial sliding(double period_s = 0.02) {
  Trial trial;
  trial.method = "sliding_mode";
  trial.period_s = period_s;
  trial.duration_s = 10.0;
  return trial;
}

class SlidingMode : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(SlidingMode, MovesTheRobotAlongThoughFrictionAndMassDiffer) {
  Trial trial = sliding();
  trial.friction_share = GetParam().first;
  trial.mass_share = GetParam().second;
  const Tracking found = run(mamba(), trial);
  Trial angles = trial;
  angles.method = "undulation";
  EXPECT_LT(found.error_rad, 0.04) << "a twelfth of the joints' amplitude";
  EXPECT_GT(found.speed_m_s, 0.9 * run(mamba(), angles).speed_m_s);
  EXPECT_LT(found.torque_nm, 1.5) << "the joints do not swing";
}

INSTANTIATE_TEST_SUITE_P(Bodies, SlidingMode,
                         ::testing::Values(std::pair(1.0, 1.0), std::pair(0.7, 1.0), std::pair(1.3, 1.0),
                                           std::pair(1.0, 0.7), std::pair(1.0, 1.3)));

// The estimate of unknown torques took the push of the ground for a disturbance: in turns the body reared up by 0.03 m.
TEST(SlidingModeAlone, TheBodyStaysOnTheGroundInATurn) {
  for (const double curvature_1_m : {-0.8, 0.8}) {
    Trial turn = sliding();
    turn.curvature_1_m = curvature_1_m;
    const Tracking found = run(mamba(), turn);
    EXPECT_LT(found.raised_m, 0.003) << curvature_1_m;
    EXPECT_LT(found.error_rad, 0.06) << curvature_1_m;
  }
}

TEST(SlidingModeAlone, WithoutTheModelTheTickIsTooLong) {
  // The same law with the inertia of each joint by itself and without the estimate of unknown torques. A shorter tick
  // allows gains that make up for both.
  Trial slow = sliding(0.02);
  slow.config.sliding.inertia = 1;
  slow.config.sliding.estimate_s = 1e3;
  EXPECT_GT(run(mamba(), slow).error_rad, 0.15);
  Trial fast = sliding(0.004);
  fast.config.sliding = slow.config.sliding;
  fast.config.sliding.surface_1_s = 20.0;
  fast.config.sliding.reaching_rad_s2 = 200.0;
  fast.config.sliding.layer_rad_s = 4.0;
  EXPECT_LT(run(mamba(), fast).error_rad, 0.06);
}

}  // namespace
}  // namespace constrictor::sliding_mode
