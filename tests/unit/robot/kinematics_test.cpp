// Kinematics compared with simple geometry.
#include "robot/kinematics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace constrictor {
namespace {

RobotModel robot_of(std::size_t modules, std::vector<JointAxis> pattern) {
  RobotModel robot;
  robot.module_count = modules;
  robot.module_length_m = 0.1;
  for (std::size_t i = 0; i + 1 < modules; ++i) {
    JointModel joint;
    joint.axis = pattern[i % pattern.size()];
    robot.joints.push_back(joint);
  }
  return robot;
}

TEST(Kinematics, AStraightBodyTrailsTheHead) {
  const RobotModel robot = robot_of(5, {JointAxis::kYaw});
  const auto poses = module_poses(robot, std::vector<double>(4, 0.0));
  ASSERT_EQ(poses.size(), 5U);
  EXPECT_NEAR(poses[4].translation().x(), -0.4, 1e-12);
  EXPECT_NEAR(poses[4].translation().tail<2>().norm(), 0.0, 1e-12);
}

TEST(Kinematics, PositiveYawTurnsTheHeadSideLeft) {
  // The module ahead of the joint turns to the left, so that it lies at positive y in the frame of the module behind.
  const RobotModel robot = robot_of(2, {JointAxis::kYaw});
  const auto poses = module_poses(robot, std::vector<double>{0.5});
  const Eigen::Vector3d p_TailHead = (poses[1].inverse() * poses[0]).translation();
  EXPECT_NEAR(p_TailHead.y(), 0.05 * std::sin(0.5), 1e-12);
  EXPECT_NEAR(p_TailHead.x(), 0.05 + 0.05 * std::cos(0.5), 1e-12);
}

TEST(Kinematics, PositivePitchTurnsTheHeadSideDown) {
  const RobotModel robot = robot_of(2, {JointAxis::kPitch});
  const auto poses = module_poses(robot, std::vector<double>{0.5});
  EXPECT_NEAR((poses[1].inverse() * poses[0]).translation().z(), -0.05 * std::sin(0.5), 1e-12);
}

TEST(Kinematics, FourRightAnglesCloseASquare) {
  const RobotModel robot = robot_of(5, {JointAxis::kYaw});
  const auto poses = module_poses(robot, std::vector<double>(4, std::numbers::pi / 2));
  EXPECT_NEAR((poses[4].translation() - poses[0].translation()).norm(), 0.0, 1e-12);
}

TEST(Kinematics, NeighboursMeetAtTheirJoint) {
  const RobotModel robot = robot_of(12, {JointAxis::kYaw, JointAxis::kPitch});
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> angle(-1.5, 1.5);
  std::vector<double> angles(11);
  for (double& value : angles) value = angle(generator);
  Eigen::Isometry3d X_WHead = Eigen::Isometry3d::Identity();
  X_WHead.linear() = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  X_WHead.translation() = Eigen::Vector3d(1, -2, 0.5);
  const auto poses = module_poses(robot, angles, X_WHead);
  for (std::size_t i = 0; i + 1 < poses.size(); ++i) {
    const Eigen::Vector3d behind = poses[i] * Eigen::Vector3d(-0.05, 0, 0);
    const Eigen::Vector3d ahead = poses[i + 1] * Eigen::Vector3d(0.05, 0, 0);
    EXPECT_NEAR((behind - ahead).norm(), 0.0, 1e-12);
    // The angle between the two x axes is the angle of the joint.
    const double cosine = poses[i].linear().col(0).dot(poses[i + 1].linear().col(0));
    EXPECT_NEAR(std::acos(cosine), std::abs(angles[i]), 1e-7);
  }
}

TEST(Kinematics, PlanarChainAgreesWithSpatialChainOnFlatGround) {
  const RobotModel robot = robot_of(24, {JointAxis::kYaw, JointAxis::kPitch});
  std::vector<double> angles(23, 0.0);
  for (std::size_t i = 0; i < 23; i += 2) angles[i] = 0.6 * std::sin(0.9 * static_cast<double>(i));
  const PlanarPose head{{0.3, -0.2}, 2.5};
  Eigen::Isometry3d X_WHead = Eigen::Isometry3d::Identity();
  X_WHead.linear() = Eigen::AngleAxisd(head.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  X_WHead.translation() = Eigen::Vector3d(head.p.x(), head.p.y(), 0.0);
  const auto spatial = module_poses(robot, angles, X_WHead);
  const auto planar = planar_module_poses(robot, angles, head);
  for (std::size_t i = 0; i < planar.size(); ++i) {
    EXPECT_NEAR(planar[i].p.x(), spatial[i].translation().x(), 1e-12);
    EXPECT_NEAR(planar[i].p.y(), spatial[i].translation().y(), 1e-12);
    EXPECT_NEAR(std::sin(planar[i].yaw_rad), spatial[i].linear()(1, 0), 1e-12);
    const Eigen::Vector3d point = spatial[i] * Eigen::Vector3d(0.01, 0.02, 0.0);
    EXPECT_NEAR((planar[i].to_parent({0.01, 0.02}) - point.head<2>()).norm(), 0.0, 1e-12);
  }
}

}  // namespace
}  // namespace constrictor
