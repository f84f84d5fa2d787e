#include "robot/robot_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "configuration/configuration.hpp"
#include "robot/joint_limits.hpp"
#include "robot/u_arms.hpp"
#include "support/project.hpp"
#include "support/usual_joint.hpp"

namespace constrictor {
namespace {

const std::filesystem::path kRobots = testing::source_path("components/lib/robot");

/// A copy of mamba.yaml in which one line is replaced.
std::string error_of_changed_file(const std::string& from, const std::string& to) {
  std::ifstream original(kRobots / "mamba.yaml");
  std::ostringstream stream;
  stream << original.rdbuf();
  std::string text = stream.str();
  const std::size_t at = text.find(from);
  if (at == std::string::npos) return "the file has no " + from;
  text.replace(at, from.size(), to);
  const std::filesystem::path file = std::filesystem::path(::testing::TempDir()) / "robot_model_test.yaml";
  std::ofstream(file) << text;
  try {
    (void)load_robot(file);
  } catch (const ConfigurationError& error) {
    const std::string what = error.what();
    return what.substr(what.find(": ") + 2);
  }
  return {};
}

TEST(RobotModel, MambaHasTheSizesOfTheStudy) {
  const RobotModel robot = load_robot(kRobots / "mamba.yaml");
  EXPECT_EQ(robot.module_count, 24U);
  EXPECT_EQ(robot.joints.size(), 23U);
  EXPECT_EQ(robot.yaw_joints().size(), 12U);
  EXPECT_EQ(robot.yaw_joints()[1], 2U);
  EXPECT_EQ(robot.joints[1].axis, JointAxis::kPitch);
  EXPECT_EQ(robot.joints[22].axis, JointAxis::kYaw);
  EXPECT_NEAR(robot.module_length_m * 24, 2.1, 0.05);
  EXPECT_EQ(robot.joints[0].stiffness_nm_rad, 0.0);
}

TEST(RobotModel, ASkinWithoutContactSensorsIsStated) {
  EXPECT_TRUE(load_robot(kRobots / "mamba.yaml").contact_sensors);
  EXPECT_TRUE(load_robot(kRobots / "mamba.yaml").imu);
  EXPECT_FALSE(load_robot(kRobots / "mamba_no_skin.yaml").contact_sensors);
}

TEST(RobotModel, ABodyWithoutPitchJointsHasTwiceAsManyLinksInThePlane) {
  const RobotModel robot = load_robot(kRobots / "mamba_yaw_only.yaml");
  EXPECT_EQ(robot.yaw_joints().size(), 23U);
  EXPECT_DOUBLE_EQ(link_share(robot), 0.5);
  EXPECT_DOUBLE_EQ(link_share(load_robot(kRobots / "mamba.yaml")), 1.0);
  EXPECT_FALSE(base_hinges(robot, 9, 14)) << "no joint can raise the base";
}

TEST(RobotModel, TheHingesOfABaseAreThePitchJointsBesideIt) {
  const RobotModel robot = load_robot(kRobots / "mamba.yaml");
  const auto hinges = base_hinges(robot, 10, 14);
  ASSERT_TRUE(hinges);
  EXPECT_EQ((*hinges)[0], 9U);
  EXPECT_EQ((*hinges)[1], 15U);
  EXPECT_FALSE(base_hinges(robot, 10, 10)) << "a base of one joint has no length";
  EXPECT_TRUE(base_hinges(robot, 12, 16));
  EXPECT_FALSE(base_hinges(robot, 14, 18)) << "the rear arm has five modules, 0.45 m";
  EXPECT_FALSE(base_hinges(robot, 4, 8)) << "the front arm has five modules";
}

TEST(RobotModel, SerpensIsElastic) { EXPECT_GT(load_robot(kRobots / "serpens.yaml").joints[5].stiffness_nm_rad, 0.0); }

TEST(RobotModel, CameraSeesTheGroundJustAheadAndTheHorizon) {
  const RobotModel robot = load_robot(kRobots / "mamba.yaml");
  const CameraModel& camera = robot.camera;
  const double half_height =
      std::atan(std::tan(0.5 * camera.horizontal_fov_rad) * camera.height / static_cast<double>(camera.width));
  EXPECT_GT(half_height, camera.tilt_rad);  // the uppermost ray rises
  const double height_m = robot.module_radius_m + camera.p_HC.z();
  const double nearest_m = camera.p_HC.x() + height_m / std::tan(camera.tilt_rad + half_height);
  EXPECT_GT(nearest_m, 0.08);
  EXPECT_LT(nearest_m, 0.15);
  // The lowest ray passes the front cap of the head, which is a sphere around its front end.
  const Eigen::Vector2d to_cap(0.5 * robot.module_length_m - camera.p_HC.x(), -camera.p_HC.z());
  const double angle = camera.tilt_rad + half_height;
  EXPECT_GT(std::abs(std::cos(angle) * to_cap.y() + std::sin(angle) * to_cap.x()), robot.module_radius_m);
}

TEST(RobotModel, ErrorNamesTheMistake) {
  EXPECT_EQ(error_of_changed_file("mass_kg: 0.3", "mass_kg: -1"), "module.mass_kg: found -1, accepted 0.01 to 20");
  EXPECT_EQ(error_of_changed_file("count: 24", "count: 8"),
            "module.count: found 8 modules with 4 yaw joints, accepted a robot with at least 5 yaw joints (10 modules "
            "if the axes alternate)");
  EXPECT_EQ(error_of_changed_file("count: 24", "count: 10"), "");
  EXPECT_EQ(error_of_changed_file("name: mamba", "name: mamba\nimu: {present: false}"), "");
  EXPECT_EQ(error_of_changed_file("name: mamba", "name: mamba\nimu: {presence: false}").substr(0, 41),
            "imu.presence: found an unknown key, accep");
  EXPECT_EQ(error_of_changed_file("count: 24", "count: 65"), "module.count: found 65, accepted a whole number 2 to 64");
  EXPECT_EQ(error_of_changed_file("axes: [yaw, pitch]", "axes: [yaw, roll]"),
            "joints.axes[1]: found roll, accepted one of yaw, pitch");
  EXPECT_EQ(error_of_changed_file("axes: [yaw, pitch]", "axes: []"),
            "joints.axes: found a list of 0, accepted a list of yaw and pitch");
  EXPECT_EQ(
      error_of_changed_file("max_torque_nm: 6.0", "gear_friction_nm: 6\n  max_torque_nm: 6.0"),
      "joints.gear_friction_nm: found 6 Nm, accepted less than max_torque_nm (6 Nm): the motor would turn nothing");
  EXPECT_EQ(error_of_changed_file("max_torque_nm: 6.0", "no_load_speed_rad_s: 3\n  max_torque_nm: 6.0"),
            "joints.no_load_speed_rad_s: found 3 rad/s, accepted 0 (torque does not fall with speed), or at least "
            "max_speed_rad_s (4 rad/s), at which the motor must still turn");
  EXPECT_EQ(error_of_changed_file("max_torque_nm: 6.0", "damping_nm_s_rad: 1\n  max_torque_nm: 6.0"),
            "joints.damping_nm_s_rad: found damping without stiffness_nm_rad, accepted 0 for a stiff joint");
  EXPECT_EQ(error_of_changed_file("max_torque_nm: 6.0", "backlash_rad: 0.01\n  max_torque_nm: 6.0"),
            "joints.backlash_rad: found backlash without stiffness_nm_rad, which is the stiffness of the gear");
  EXPECT_EQ(error_of_changed_file("  width: 320", "  width: 31"),
            "camera.width: found 31, accepted a whole number 32 to 4096");  // perception refuses smaller images
  EXPECT_EQ(error_of_changed_file("  tilt_rad: 0.3", "  tilt: 0.3"),
            "camera.tilt_rad: found nothing, accepted -1.5 to 1.5; line 30 has a key 'tilt': rename it if it is meant");
  EXPECT_EQ(error_of_changed_file("name: mamba", "name: mamba\ncolour: green").substr(0, 42),
            "colour: found an unknown key, accepted the");
}

TEST(RobotModel, ACameraThatSeesNoGroundIsRefused) {
  EXPECT_EQ(error_of_changed_file("  tilt_rad: 0.3", "  tilt_rad: -1.0"),
            "camera.tilt_rad: found -1, accepted -0.594 or more: no ground would be in view");
  EXPECT_EQ(error_of_changed_file("  tilt_rad: 0.3", "  tilt_rad: -0.5"), "");
  EXPECT_EQ(error_of_changed_file("radius_m: 0.035", "radius_m: 0.06"),
            "camera.position_m: found a place 0.0523 m from the axis of the module, accepted more than 0.06 m "
            "(module.radius_m): the module hides everything else");
  EXPECT_EQ(
      error_of_changed_file("position_m: [0.06, 0.0, 0.05]", "position_m: [0.1, 0.0, -0.03]"),
      "camera.position_m: found z = -0.03 m, accepted -0.015 m or more: the ground is 0.035 m below the centre of "
      "the module");
}

TEST(RobotModel, EveryShippedRobotIsAccepted) {
  std::size_t robots = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kRobots)) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_NO_THROW((void)load_robot(entry.path())) << entry.path();
    ++robots;
  }
  EXPECT_GE(robots, 6U);
}

TEST(JointLimits, RejectUnacceptableSetpoints) {
  const JointModel joint = testing::usual_joint();
  EXPECT_TRUE(is_acceptable(joint, {0.5, 100.0, 100.0}));
  EXPECT_FALSE(is_acceptable(joint, {2.0, 0.0, 1.0}));
  EXPECT_FALSE(is_acceptable(joint, {0.0, 0.0, -1.0}));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_acceptable(joint, {nan, 0.0, 1.0}));
  EXPECT_FALSE(is_acceptable(joint, {0.0, nan, 1.0}));
  EXPECT_FALSE(is_acceptable(joint, {0.0, 0.0, nan}));
  const JointSetpoint clamped = clamp_to_limits(joint, {9.0, -9.0, 9.0});
  EXPECT_EQ(clamped.position_rad, joint.max_rad);
  EXPECT_EQ(clamped.velocity_rad_s, -joint.max_speed_rad_s);
  EXPECT_EQ(clamped.torque_limit_nm, joint.max_torque_nm);
}

}  // namespace
}  // namespace constrictor
