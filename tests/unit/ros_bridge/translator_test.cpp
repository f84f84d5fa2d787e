// ROS 2 messages of the bridge against the conventions of REP 103, REP 105 and the message definitions; motions that
// follow from ROS 2 velocities.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>

#include "component/data_path.hpp"
#include "constrictor/text.hpp"
#include "robot/kinematics.hpp"
#include "ros_bridge/ros_translator.hpp"

namespace constrictor::ros_bridge {
namespace {

RobotModel mamba() { return load_robot(data_path("components/lib/robot/mamba.yaml")); }

Eigen::Isometry3d isometry(const geometry_msgs_msg_dds__Transform_& t) {
  Eigen::Isometry3d X = Eigen::Isometry3d::Identity();
  X.translation() << t.translation.x, t.translation.y, t.translation.z;
  X.linear() = Eigen::Quaterniond(t.rotation.w, t.rotation.x, t.rotation.y, t.rotation.z).toRotationMatrix();
  return X;
}

msg::JointState bent() {
  msg::JointState joints{};
  joints.joint_count = 23;
  for (int i = 0; i < 23; ++i) {
    joints.position_rad[i] = 0.05 * (i % 7 - 3);
    joints.velocity_rad_s[i] = 0.1 * i;
    joints.torque_nm[i] = -0.2 * i;
  }
  joints.header.time_ns = 3'020'000'000;
  return joints;
}

TEST(RosTranslator, JointStatesCarryNamesAnglesRatesAndTorques) {
  Translator translator(mamba());
  const msg::JointState joints = bent();
  const JointState out = translator.joint_state(joints);
  EXPECT_EQ(out.header.stamp.sec, 3);
  EXPECT_EQ(out.header.stamp.nanosec, 20'000'000u);
  ASSERT_EQ(out.name._length, 23u);
  ASSERT_EQ(out.position._length, 23u);
  ASSERT_EQ(out.velocity._length, 23u);
  ASSERT_EQ(out.effort._length, 23u);
  EXPECT_STREQ(out.name._buffer[0], "joint_00");
  EXPECT_STREQ(out.name._buffer[22], "joint_22");
  for (std::size_t i = 0; i < 23; ++i) {
    EXPECT_EQ(out.position._buffer[i], joints.position_rad[i]);
    EXPECT_EQ(out.velocity._buffer[i], joints.velocity_rad_s[i]);
    EXPECT_EQ(out.effort._buffer[i], joints.torque_nm[i]);
  }
}

TEST(RosTranslator, FramesOfModulesAreWhereKinematicsPutsThem) {
  const RobotModel robot = mamba();
  Translator translator(robot);
  msg::RobotPose pose{};
  pose.x_m = 1.5;
  pose.y_m = -0.5;
  pose.yaw_rad = 0.7;
  const msg::JointState joints = bent();
  const TFMessage tf = translator.transforms(pose, joints);
  ASSERT_EQ(tf.transforms._length, robot.module_count);
  std::map<std::string, Eigen::Isometry3d> frames{{"odom", Eigen::Isometry3d::Identity()}};
  for (std::size_t i = 0; i < tf.transforms._length; ++i) {
    const auto& t = tf.transforms._buffer[i];
    ASSERT_TRUE(frames.contains(t.header.frame_id))
        << t.child_frame_id << " has the unknown parent " << t.header.frame_id;
    ASSERT_FALSE(frames.contains(t.child_frame_id)) << "more than one parent of " << t.child_frame_id;
    frames[t.child_frame_id] = frames.at(t.header.frame_id) * isometry(t.transform);
  }
  Eigen::Isometry3d head = Eigen::Isometry3d::Identity();
  head.translation() << pose.x_m, pose.y_m, robot.module_radius_m;
  head.linear() = Eigen::AngleAxisd(pose.yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const auto expected = module_poses(robot, std::span(joints.position_rad, 23), head);
  EXPECT_LT((frames.at("base_link").matrix() - expected[0].matrix()).norm(), 1e-12);
  for (std::size_t i = 1; i < expected.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "module_%02zu", i);
    // The frame lies on the joint, half a module ahead of the centre; it turns with the module.
    const Eigen::Isometry3d centre = frames.at(name) * Eigen::Translation3d(-0.5 * robot.module_length_m, 0, 0);
    EXPECT_LT((centre.matrix() - expected[i].matrix()).norm(), 1e-12) << name;
    const Eigen::Vector3d end_ahead = expected[i - 1] * Eigen::Vector3d(-0.5 * robot.module_length_m, 0, 0);
    EXPECT_LT((frames.at(name).translation() - end_ahead).norm(), 1e-12) << name << " is not on its joint";
  }
}

TEST(RosTranslator, OdometryHasTheCovarianceOfXYAndYawInRosOrder) {
  Translator translator(mamba());
  msg::RobotPose pose{};
  pose.yaw_rad = std::numbers::pi / 2;
  pose.speed_m_s = 0.4;
  for (int i = 0; i < 9; ++i) pose.covariance[i] = 1.0 + i;
  msg::ImuState imu{};
  imu.angular_velocity_rad_s.z = 0.3;
  const Odometry out = translator.odometry(pose, imu);
  EXPECT_STREQ(out.header.frame_id, "odom");
  EXPECT_STREQ(out.child_frame_id, "base_link");
  EXPECT_NEAR(out.pose.pose.orientation.z, std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(out.pose.pose.orientation.w, std::sqrt(0.5), 1e-12);
  EXPECT_EQ(out.twist.twist.linear.x, 0.4);
  EXPECT_EQ(out.twist.twist.angular.z, 0.3);
  const std::map<int, double> placed{{0, 1}, {1, 2}, {5, 3}, {6, 4}, {7, 5}, {11, 6}, {30, 7}, {31, 8}, {35, 9}};
  for (int i = 0; i < 36; ++i) EXPECT_EQ(out.pose.covariance[i], placed.contains(i) ? placed.at(i) : 0.0) << i;
}

TEST(RosTranslator, ImagesAreStampedWithTheirExposure) {
  Translator translator(mamba());
  std::vector<std::uint8_t> pixels(12 * 7 * 3, 9);
  msg::CameraImage image{};
  image.width = 12;
  image.height = 7;
  image.header.tick = 52;
  image.header.time_ns = 52 * 20'000'000LL;
  image.exposure_tick = 50;
  image.data._buffer = pixels.data();
  image.data._length = static_cast<std::uint32_t>(pixels.size());
  const Image out = translator.image(image);
  EXPECT_EQ(out.header.stamp.sec, 1);
  EXPECT_EQ(out.header.stamp.nanosec, 0u);
  EXPECT_STREQ(out.encoding, "rgb8");
  EXPECT_EQ(out.step, 36u);
  EXPECT_EQ(out.data._length, out.step * out.height);
  EXPECT_EQ(out.data._buffer, pixels.data());
  EXPECT_FALSE(out.data._release);
}

TEST(RosTranslator, ThePrincipalPointCountsPixelCentresFromZero) {
  Translator translator(mamba());
  msg::CameraInfo info{};
  info.width = 320;
  info.height = 240;
  info.fx = info.fy = 200;
  info.cx = 160;
  info.cy = 120;
  const CameraInfo out = translator.camera_info(info);
  EXPECT_EQ(out.k[2], 159.5);
  EXPECT_EQ(out.k[5], 119.5);
  EXPECT_EQ(out.p[2], 159.5);
  EXPECT_EQ(out.d._length, 5u);
}

TEST(RosTranslator, LogLinesHaveRosLevelsAndTheTimeOfTheirTick) {
  Translator translator(mamba());
  msg::LogLine line{};
  set_text(line.process, "navigation,control");
  set_text(line.message, "line lost\x1b[2J");
  line.tick = 75;
  line.level = msg::kLogWarning;
  Log out = translator.log(line, 20'000'000);
  EXPECT_EQ(out.stamp.sec, 1);
  EXPECT_EQ(out.stamp.nanosec, 500'000'000u);
  EXPECT_EQ(out.level, 30);  // WARN of rcl_interfaces/msg/Log.msg
  EXPECT_STREQ(out.name, "navigation,control");
  EXPECT_STREQ(out.msg, "line lost?[2J");
  set_text(line.component, "control");
  line.tick = -1;
  line.level = msg::kLogError;
  out = translator.log(line, 20'000'000);
  EXPECT_STREQ(out.name, "control");
  EXPECT_EQ(out.stamp.sec, 0);
  EXPECT_EQ(out.level, 40);
  line.level = msg::kLogInfo;
  EXPECT_EQ(translator.log(line, 20'000'000).level, 20);
  line.tick = std::numeric_limits<std::int64_t>::max();
  EXPECT_GE(translator.log(line, 20'000'000).stamp.sec, 0);
}

Twist twist(double speed_m_s, double turn_rad_s) {
  Twist t{};
  t.linear.x = speed_m_s;
  t.angular.z = turn_rad_s;
  return t;
}

TEST(RosVelocity, BecomesAnUndulationOfThatSpeedAndTurningRate) {
  const DriveConfig config;
  const Drive straight = drive_of(twist(0.45, 0));
  EXPECT_NEAR(straight.speed_m_s, 0.45, 1e-12);
  EXPECT_EQ(straight.curvature_1_m, 0);
  EXPECT_GT(drive_of(twist(0.4, 0.3)).curvature_1_m, 0);  // to the left
  const Drive back = drive_of(twist(-0.4, 0.2));
  EXPECT_LT(back.speed_m_s, 0);
  EXPECT_NEAR(back.curvature_1_m * -0.4, 0.2, 1e-12);
  const Drive spot = drive_of(twist(0, -1));
  EXPECT_EQ(spot.curvature_1_m, -config.max_curvature_1_m);
  EXPECT_GT(spot.speed_m_s, 0);
}

TEST(RosVelocity, AHostileVelocityGivesABoundedMotion) {
  const DriveConfig config;
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(drive_of(twist(0, 0)), Drive{});
  for (const double v : {0.0, 0.3, 1e300, -1e300, kInf, kNaN}) {
    for (const double w : {0.0, -0.3, 1e300, kInf, kNaN}) {
      const Drive drive = drive_of(twist(v, w));
      EXPECT_LE(std::abs(drive.speed_m_s), config.max_speed_m_s) << v << " " << w;
      EXPECT_LE(std::abs(drive.curvature_1_m), config.max_curvature_1_m) << v << " " << w;
      const bool stands = drive == Drive{};
      EXPECT_TRUE(stands || (std::isfinite(v) && std::isfinite(w)));
    }
  }
}

}  // namespace
}  // namespace constrictor::ros_bridge
