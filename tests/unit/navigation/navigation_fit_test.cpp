// Robots with more and fewer modules: the place of the base of the U, and the parameters that follow from the length.
#include "navigation/navigation_fit.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "configuration/configuration.hpp"
#include "navigation/grip.hpp"
#include "navigation/motions.hpp"
#include "navigation/navigation.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

/// `mamba` with another number of modules.
RobotModel robot_with(std::size_t modules) {
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  robot.module_count = modules;
  robot.joints.resize(modules - 1, robot.joints.front());
  for (std::size_t i = 0; i < robot.joints.size(); ++i)
    robot.joints[i].axis = i % 2 == 0 ? JointAxis::kYaw : JointAxis::kPitch;
  return robot;
}

TEST(NavigationFit, TheBaseLiesInTheMiddleOfTheBody) {
  for (std::size_t modules = 16; modules <= 64; ++modules) {
    const RobotModel robot = robot_with(modules);
    const std::vector<std::size_t> yaw_joints = robot.yaw_joints();
    const auto first = static_cast<std::size_t>(middle_base_joint(robot, 3));
    ASSERT_LT(first + 3, yaw_joints.size()) << modules << " modules: a joint remains behind the base";
    const double front_m = static_cast<double>(yaw_joints[first] + 1) * robot.module_length_m;
    const double rear_m = static_cast<double>(modules - 1 - yaw_joints[first + 2]) * robot.module_length_m;
    EXPECT_GE(front_m, 0.75) << modules << " modules";
    // Two yaw joints lie 0.18 m apart, and the base cannot lie exactly in the middle.
    if (modules >= 20) {
      EXPECT_LE(std::abs(front_m - rear_m), 0.2) << modules << " modules";
    }
  }
}

TEST(NavigationFit, TheBaseOfKnownRobots) {
  EXPECT_EQ(middle_base_joint(robot_with(16), 3), 4);
  EXPECT_EQ(middle_base_joint(robot_with(24), 3), 5);
  EXPECT_EQ(middle_base_joint(robot_with(32), 3), 7);
}

TEST(NavigationFit, ABaseBeyondTheTailIsRefused) {
  const RobotModel robot = robot_with(24);
  GripConfig config;
  config.base_first_joint = 9;
  EXPECT_EQ(GripSense(robot, config).base_first_joint(), 9U);
  config.base_first_joint = 10;
  try {
    const GripSense sense(robot, config);
    FAIL() << "accepted";
  } catch (const ConfigurationError& error) {
    EXPECT_STREQ(error.what(),
                 "navigation: grip.base_first_joint: found 10 with 3 base_joints, accepted at most 9 for "
                 "the 12 yaw joints of the robot mamba");
  }
}

/// Why navigation does not grasp with this body.
std::string refusal_of(const RobotModel& robot) {
  const NavigationConfig config = navigation_fitted_to(robot, {});
  return GripSense(robot, config.grip).refusal();
}

/// This bound follows from lengths: the arm in front of the base, which drives and steers, has at least 0.75 m, and one
/// yaw joint lies behind the three of the base.
TEST(NavigationFit, ABodyWithoutRoomForTheArmsOfAUCannotGrasp) {
  for (const std::size_t modules : {10U, 12U, 14U, 15U})
    EXPECT_NE(refusal_of(robot_with(modules)).find("cannot grasp"), std::string::npos) << modules << " modules";
  for (std::size_t modules = 16; modules <= 64; ++modules)
    EXPECT_EQ(refusal_of(robot_with(modules)), "") << modules << " modules";
  RobotModel yaw_only = load_robot(data_path("components/lib/robot/mamba_yaw_only.yaml"));
  EXPECT_EQ(refusal_of(yaw_only), "");
  yaw_only.module_count = 12;
  yaw_only.joints.resize(11);
  EXPECT_NE(refusal_of(yaw_only).find("accepted at least 0.75 m"), std::string::npos) << refusal_of(yaw_only);
}

/// Missions of `short` with three seeds each, and with two for 24 modules.
TEST(NavigationFit, ABodyWhoseArmsHaveTooFewJointsCannotGrasp) {
  const auto of = [](std::size_t modules, double length_m) {
    RobotModel robot = robot_with(modules);
    robot.module_length_m = length_m;
    return refusal_of(robot);
  };
  EXPECT_EQ(of(18, 0.12), "") << "3 of 3 missions succeeded";
  EXPECT_EQ(of(24, 0.12), "") << "2 of 2";
  EXPECT_EQ(of(16, 0.105), "") << "3 of 3";
  EXPECT_EQ(of(30, 0.07), "");
  for (const auto& [modules, length_m] : {std::pair{14U, 0.12}, {14U, 0.14}, {16U, 0.12}, {16U, 0.135}})
    EXPECT_NE(of(modules, length_m).find("module.count"), std::string::npos) << modules << ", " << length_m << ": none";
  EXPECT_EQ(of(14, 0.15),
            "the robot mamba cannot grasp: module.count: found 14 of 0.15 m, accepted more modules: the arms of its U "
            "would have 2 and 2 yaw joints, accepted at least 4 in front of it, or 3 in each");
}

TEST(NavigationFit, ABodyWhoseLinksAreTooLongForAWaveCannotGrasp) {
  RobotModel robot = robot_with(24);
  robot.module_length_m = 0.15;
  EXPECT_EQ(refusal_of(robot), "") << "3.6 links; 1 of 2 missions of `short` succeeded";
  robot.module_length_m = 0.2;
  EXPECT_EQ(refusal_of(robot),
            "the robot mamba cannot grasp: module.length_m: found 0.2, accepted at most 0.178: its yaw joints would be "
            "0.40 m apart, and a wave of 1.07 m needs 3 links");
  for (JointModel& joint : robot.joints) joint.axis = JointAxis::kYaw;
  EXPECT_EQ(refusal_of(robot), "") << "the yaw joints are as near to each other as modules";
}

/// `mamba` with joints of this range, the same to either side, and this torque.
RobotModel robot_with_joints(double range_rad, double max_torque_nm, std::size_t modules = 24) {
  RobotModel robot = robot_with(modules);
  for (JointModel& joint : robot.joints) {
    joint.min_rad = -range_rad;
    joint.max_rad = range_rad;
    joint.max_torque_nm = max_torque_nm;
  }
  return robot;
}

TEST(NavigationFit, JointsThatCannotFormAUCannotGrasp) {
  EXPECT_EQ(refusal_of(robot_with_joints(0.5, 6.0)),
            "the robot mamba cannot grasp: joints.max_rad: found 0.5, accepted at least 1.047 to bend to the open U");
  EXPECT_EQ(refusal_of(robot_with_joints(1.047, 6.0)), "");
  RobotModel one_sided = robot_with_joints(1.5, 6.0);
  for (JointModel& joint : one_sided.joints) joint.min_rad = -0.5;
  EXPECT_EQ(refusal_of(one_sided),
            "the robot mamba cannot grasp: joints.min_rad: found -0.5, accepted at most -1.047 to bend to the open U")
      << "an object may lie on either side";
  // The base of more joints bends each of them less.
  RobotModel yaw_only = robot_with_joints(0.6, 6.0);
  for (JointModel& joint : yaw_only.joints) joint.axis = JointAxis::kYaw;
  EXPECT_EQ(refusal_of(yaw_only), "");
  // The range of the pitch joints does not matter.
  RobotModel stiff = robot_with(24);
  for (JointModel& joint : stiff.joints) joint.max_rad = joint.axis == JointAxis::kYaw ? joint.max_rad : 0.3;
  EXPECT_EQ(refusal_of(stiff), "");
}

TEST(NavigationFit, JointsThatAreTooWeakToHoldAnObjectCannotGrasp) {
  EXPECT_EQ(refusal_of(robot_with_joints(1.5, 1.0)),
            "the robot mamba cannot grasp: joints.max_torque_nm: found 1, accepted at least 1.5 to hold an object");
  for (const std::size_t modules : {16U, 24U, 28U, 32U, 40U, 64U})
    EXPECT_EQ(refusal_of(robot_with_joints(1.5, 1.5, modules)), "") << modules << " modules";
  GripConfig named;
  named.base_first_joint = 5;
  const RobotModel weak = robot_with_joints(1.5, 1.0);
  EXPECT_NE(GripSense(weak, named).refusal(), "") << "where the base lies makes its joints no stronger";
}

TEST(NavigationFit, EveryShippedRobotCanGrasp) {
  for (const char* robot : {"mamba", "mamba_mx106", "mamba_no_skin", "mamba_two_cameras", "mamba_yaw_only", "serpens"})
    EXPECT_EQ(refusal_of(load_robot(data_path(std::string("components/lib/robot/") + robot + ".yaml"))), "") << robot;
}

/// The error of a navigation that gets this mission, or "" if it accepts it.
std::string error_of(const std::string& robot_file, const std::string& mission) {
  Setup setup;
  setup.robot_file = robot_file;
  setup.mission = mission;
  try {
    const LocalRun run({testing::still_robot(), make_navigation_factory()}, setup);
  } catch (const ConfigurationError& error) {
    return error.what();
  }
  return "";
}

TEST(NavigationFit, AMissionThatNeedsAGraspIsRefusedBeforeItStarts) {
  const std::string mamba = data_path("components/lib/robot/mamba.yaml");
  std::ifstream from(mamba);
  std::string text{std::istreambuf_iterator<char>(from), {}};
  text.replace(text.find("count: 24"), 9, "count: 12");
  const std::string small = ::testing::TempDir() + "/mamba_12.yaml";
  std::ofstream(small) << text;

  EXPECT_EQ(error_of(mamba, "{sequence: [green], line_colour: blue}"), "");
  EXPECT_EQ(error_of(small, "{sequence: [], line_colour: blue}"), "");
  const std::string found = error_of(small, "{sequence: [green, red], line_colour: blue}");
  EXPECT_EQ(found, small +
                       ": the robot mamba cannot grasp: module.count: found 12 of 0.089 m, accepted more or longer "
                       "modules: the arm in front of its U would be 0.44 m long, accepted at least 0.75 m; "
                       "mission.sequence demands 2 objects");
  EXPECT_EQ(error_of(mamba, "{sequence: [green], line_colour: blue, known: {object_radius_m: 0.1}}"), "");
  const std::string large = error_of(mamba, "{sequence: [green], line_colour: blue, known: {object_radius_m: 0.15}}");
  EXPECT_NE(large.find("mission.known.object_radius_m: found 0.150, accepted at most 0.1"), std::string::npos) << large;
}

/// The values of all parameters, by key.
std::vector<std::pair<std::string, std::string>> values(const NavigationConfig& config) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const ParameterRow& row : config.describe()) all.emplace_back(row.key, row.value);
  return all;
}

TEST(NavigationFit, NothingChangesForTheBodyOfTheDefaultRobot) {
  EXPECT_EQ(values(navigation_fitted_to(robot_with(24), {})), values({}));
  EXPECT_NE(values(navigation_fitted_to(robot_with(16), {})), values({}));
  EXPECT_NE(values(navigation_fitted_to(robot_with(32), {})), values({}));
}

TEST(NavigationFit, ALongBodyTurnsByTheSameAngle) {
  const NavigationConfig tuned;
  const NavigationConfig fitted = navigation_fitted_to(robot_with(36), tuned);  // one and a half times as long
  EXPECT_NEAR(fitted.rotate.curvature_1_m, tuned.rotate.curvature_1_m / 1.5, 1e-9);
  EXPECT_NEAR(fitted.track.turn_radius_m, tuned.track.turn_radius_m * 1.5, 1e-9);
  EXPECT_NEAR(fitted.drop.lookahead_m, tuned.drop.lookahead_m * 1.5, 1e-9);
  EXPECT_NEAR(fitted.drop.pivot_m, tuned.drop.pivot_m * 1.5, 1e-9);
  EXPECT_NEAR(fitted.drop.clear_m, tuned.drop.clear_m * 2.25, 1e-9);
  EXPECT_NEAR(fitted.grip.hold_torque_nm, 4.0, 1e-9) << "two thirds of the joint's torque";
  const double between_nm = navigation_fitted_to(robot_with(28), tuned).grip.hold_torque_nm;
  EXPECT_NEAR(between_nm, 0.5 * (tuned.grip.hold_torque_nm + 4.0), 1e-9);
  EXPECT_EQ(fitted.rotate.carry_curvature_1_m, tuned.rotate.carry_curvature_1_m);
}

TEST(NavigationFit, AShortBodyWithAnObjectBendsByTheSameAngle) {
  const NavigationConfig tuned;
  const NavigationConfig fitted = navigation_fitted_to(robot_with(16), tuned);
  EXPECT_NEAR(fitted.rotate.carry_curvature_1_m, tuned.rotate.carry_curvature_1_m * 1.5, 1e-9);
  EXPECT_NEAR(fitted.follow_line.carry_limit_1_m, tuned.follow_line.carry_limit_1_m * 1.5, 1e-9);
  EXPECT_NEAR(fitted.drop.steering.limit, tuned.drop.steering.limit * 1.5, 1e-9);
  EXPECT_EQ(fitted.rotate.curvature_1_m, tuned.rotate.curvature_1_m);
  EXPECT_EQ(fitted.grip.hold_torque_nm, tuned.grip.hold_torque_nm);
}

TEST(NavigationFit, AnObjectIsCarriedOnARaisedBaseIfBothArmsCarryIt) {
  for (const std::size_t modules : {16U, 18U}) {
    const NavigationConfig fitted = navigation_fitted_to(robot_with(modules), {});
    EXPECT_STREQ(carrying_pace(fitted).motion, "deliver") << modules << " modules: the rear arm has three or five";
    EXPECT_EQ(carrying_pace(fitted).speed_m_s, fitted.deliver_m_s);
  }
  for (const std::size_t modules : {20U, 24U, 32U})
    EXPECT_STREQ(carrying_pace(navigation_fitted_to(robot_with(modules), {})).motion, "carry") << modules << " modules";
  NavigationConfig near_tail;
  near_tail.grip.base_first_joint = 8;
  EXPECT_STREQ(carrying_pace(navigation_fitted_to(robot_with(24), near_tail)).motion, "deliver");
}

TEST(NavigationFit, WithShorterLinksTheBaseOfTheSameUHasMoreJoints) {
  RobotModel robot = robot_with(24);
  for (JointModel& joint : robot.joints) joint.axis = JointAxis::kYaw;
  const NavigationConfig tuned, fitted = navigation_fitted_to(robot, tuned);
  EXPECT_EQ(fitted.grip.base_joints, 6);
  EXPECT_NEAR(6.0 * fitted.grip.base_angle_rad, 3.0 * tuned.grip.base_angle_rad, 1e-9);
  EXPECT_NEAR(6.0 * fitted.grip.closing_rad, 3.0 * tuned.grip.closing_rad, 1e-9);
  EXPECT_NEAR(6.0 * fitted.drop.open_angle_rad, 3.0 * tuned.drop.open_angle_rad, 1e-9);
  EXPECT_TRUE(fitted.carries_on_ground) << "no pitch joint raises the base";
  const double tuned_m = GripSense(robot_with(24), tuned.grip).largest_radius_m();
  EXPECT_NEAR(GripSense(robot, fitted.grip).largest_radius_m(), tuned_m, 0.02);
}

TEST(NavigationFit, TheHoldStaysBelowTheTorqueOfTheJoints) {
  RobotModel robot = robot_with(64);
  const NavigationConfig fitted = navigation_fitted_to(robot, {});
  EXPECT_LT(fitted.grip.hold_torque_nm, robot.joints.front().max_torque_nm);
  // A hold that the configuration demands is not weakened.
  NavigationConfig firm;
  firm.grip.hold_torque_nm = 5.0;
  EXPECT_EQ(navigation_fitted_to(robot, firm).grip.hold_torque_nm, 5.0);
}

}  // namespace
}  // namespace constrictor
