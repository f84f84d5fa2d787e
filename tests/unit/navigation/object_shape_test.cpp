// What tall, narrow and large objects ask for: a gait that does not knock them over, and a U that is wide enough.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "component/data_path.hpp"
#include "navigation/grip.hpp"
#include "navigation/motions.hpp"

namespace constrictor {
namespace {

class ObjectShape : public ::testing::Test {
 protected:
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  NavigationConfig config;
  GripSense grip_sense{robot, config.grip};

  static Grip held(double radius_m, double height_m) {
    Grip grip;
    grip.carrying = true;
    grip.side = 1.0;
    grip.radius_m = radius_m;
    grip.height_m = height_m;
    return grip;
  }
};

// A cylinder on a cart: gravity turns it back about its edge, inertia turns it over.
TEST_F(ObjectShape, AnObjectTipsWhenInertiaTurnsItOverItsEdge) {
  for (const auto& [radius_m, height_m] : {std::pair{0.05, 0.23}, {0.085, 0.15}, {0.1, 0.08}}) {
    const double mass_kg = 0.4;
    const double acceleration_m_s2 = tipping_acceleration_m_s2(held(radius_m, height_m));
    const double back_nm = mass_kg * 9.81 * radius_m;
    const double over_nm = mass_kg * acceleration_m_s2 * 0.5 * height_m;
    EXPECT_NEAR(back_nm, over_nm, 1e-12);
  }
  EXPECT_TRUE(std::isinf(tipping_acceleration_m_s2(held(0.085, 0.0)))) << "the height is unknown";
}

TEST_F(ObjectShape, TheWavesAreLimitedAroundWhatFallsOverEasily) {
  const auto limit_m_s2 = [&](const Grip& grip) {
    TaskOutput output;
    move_along(present_pace(config, grip), 0.0, 1.0, grip, output);
    keep_upright(config, grip, output);
    return output.desired.acceleration_m_s2;
  };
  double before_m_s2 = limit_m_s2(held(0.085, 0.15));
  for (const double height_m : {0.2, 0.25, 0.3}) {
    const Grip grip = held(0.05, height_m);
    EXPECT_EQ(limit_m_s2(grip), config.grip.tipping_share * tipping_acceleration_m_s2(grip));
    EXPECT_LT(limit_m_s2(grip), before_m_s2);
    before_m_s2 = limit_m_s2(grip);
  }
  EXPECT_EQ(limit_m_s2(held(0.085, 0.0)), 0.0) << "the height is unknown";
}

// The middle of a link between two base joints touches the object when the joints have closed.
TEST_F(ObjectShape, TheUOpensWiderForLargeObjects) {
  const double link_m = 2.0 * robot.module_length_m;
  EXPECT_EQ(grip_sense.open_angle_rad(0.05), config.grip.base_angle_rad);
  double before_rad = config.grip.base_angle_rad;
  for (const double radius_m : {0.09, 0.095, 0.1, 0.105}) {
    const double open_rad = grip_sense.open_angle_rad(radius_m);
    EXPECT_LT(open_rad, before_rad);
    const double closed_rad = open_rad + config.grip.closing_rad;
    EXPECT_NEAR(0.5 * link_m / std::tan(0.5 * closed_rad), radius_m + robot.module_radius_m, 1e-9);
    before_rad = open_rad;
  }
  EXPECT_EQ(grip_sense.open_angle_rad(grip_sense.largest_radius_m()), config.grip.widest_angle_rad);
}

// The middles of the links between the base joints touch a circle: its radius is the width of the U.
TEST_F(ObjectShape, AWrapMayBeWiderOrNarrower) {
  Grip grip = held(0.07, 0.15);
  const double usual_rad = grip_sense.open_angle_rad(grip);
  EXPECT_EQ(usual_rad, grip_sense.open_angle_rad(grip.radius_m));
  grip.wrap_scale = 1.15;
  EXPECT_NEAR(grip_sense.open_angle_rad(grip), usual_rad / 1.15, 1e-12);
  grip.wrap_scale = 2.0;
  EXPECT_EQ(grip_sense.open_angle_rad(grip), config.grip.widest_angle_rad);
  grip.wrap_scale = 0.9;
  EXPECT_NEAR(grip_sense.open_angle_rad(grip), usual_rad / 0.9, 1e-12);
  grip.wrap_scale = 0.1;
  const double touching_m = grip.radius_m + robot.module_radius_m;
  const double closed_rad = 2.0 * std::atan(robot.module_length_m / touching_m);
  EXPECT_NEAR(grip_sense.open_angle_rad(grip), closed_rad - 0.5 * config.grip.closing_rad, 1e-9) << "room to close";
}

TEST_F(ObjectShape, TheSqueezeClosesTheWideU) {
  const Grip grip = held(0.11, 0.15);
  TaskOutput output;
  squeeze_u(config, grip_sense, grip.side, grip, output);
  const std::size_t first = grip_sense.base_first_joint();
  EXPECT_EQ(output.desired.shape_rad[first], grip_sense.open_angle_rad(grip.radius_m));
  EXPECT_LT(output.desired.shape_rad[first], config.grip.base_angle_rad);
  // The object keeps the base open. The joints beside it close until the arms are parallel: half a circle in all.
  msg::JointState joints{};
  joints.joint_count = static_cast<std::uint16_t>(robot.joints.size());
  const std::vector<std::size_t> yaw = robot.yaw_joints();
  for (std::size_t k = first; k < first + 3; ++k) joints.position_rad[yaw[k]] = output.desired.shape_rad[first];
  const auto shape = grip_sense.hold_shape(joints, grip, true);
  double bend_rad = 0.0;
  for (std::size_t k = first - 1; k < first + 4; ++k) bend_rad += shape[k];
  EXPECT_NEAR(bend_rad, std::numbers::pi, 1e-3);
  EXPECT_NEAR(shape[first - 1], shape[first + 3], 1e-9);
  // A base that has closed farther than that has opened them in the squeeze, and they stay there.
  msg::JointState closed = joints;
  for (std::size_t k = first; k < first + 3; ++k) closed.position_rad[yaw[k]] = config.grip.base_angle_rad + 0.1;
  const double closed_rad = 3.0 * (0.1 + config.grip.hold_margin_rad);
  EXPECT_NEAR(grip_sense.hold_shape(closed, grip, true)[first - 1], -0.5 * config.grip.opening_share * closed_rad,
              1e-9);
  // The base of the closed U holds more gently than that of the wide one, which has to bear the thrust of its arms.
  Grip wide = grip, narrow = grip;
  wide.shape_rad = shape;
  narrow.shape_rad = grip_sense.hold_shape(closed, grip, true);
  grip_sense.hold_starts(wide);
  grip_sense.hold_starts(narrow);
  EXPECT_EQ(wide.hold_torque_nm, config.grip.wide_hold_torque_nm);
  EXPECT_EQ(narrow.hold_torque_nm, config.grip.hold_torque_nm);
  // A robot that feels no touches closes further, so that its torque stays at the limit.
  const auto unfelt = grip_sense.hold_shape(joints, grip, false);
  const double farther_rad = config.grip.unfelt_margin_rad - config.grip.hold_margin_rad;
  EXPECT_NEAR(grip.side * (unfelt[first] - shape[first]), farther_rad, 1e-9);
  EXPECT_GT(farther_rad * robot.joints[yaw[first]].position_gain_nm_rad, config.grip.hold_torque_nm);
}

}  // namespace
}  // namespace constrictor
