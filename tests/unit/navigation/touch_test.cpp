// Touches from the side, the place of a held object, and the monitor of its loss.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "component/data_path.hpp"
#include "navigation/grip.hpp"
#include "navigation/motions.hpp"

namespace constrictor {
namespace {

class TouchTest : public ::testing::Test {
 protected:
  RobotModel robot = load_robot(data_path("components/lib/robot/mamba.yaml"));
  GripConfig config;
  GripSense grip_sense{robot, config};
  msg::JointState joints{};
  TouchTest() { joints.joint_count = 23; }
  static msg::Contact contact(std::uint8_t module, double y_m, double ny, double nz, double force_n) {
    msg::Contact c{};
    c.module_index = module;
    c.position_m = {0.0, y_m, 0.0};
    c.normal = {0.0, ny, nz};
    c.force_n = {0.0, ny * force_n, nz * force_n};
    return c;
  }
  [[nodiscard]] msg::JointState u_joints(double side) const {
    msg::JointState u = joints;
    for (int j : {10, 12, 14}) u.position_rad[j] = side * std::numbers::pi / 3.0;
    return u;
  }
};

TEST_F(TouchTest, GroundContactsAreNotTouches) {
  msg::ContactState contacts{};
  contacts.contact_count = 2;
  contacts.contacts[0] = contact(4, 0.0, 0.0, 1.0, 3.0);
  contacts.contacts[1] = contact(4, 0.035, -1.0, 0.0, 2.0);
  const auto touches = lateral_touches(robot, planar_body(robot, joints), contacts, 0.4);
  ASSERT_EQ(touches.size(), 1U);
  EXPECT_EQ(touches[0].module, 4U);
  EXPECT_NEAR(touches[0].p_H.x(), -4 * 0.089, 1e-12);
  EXPECT_NEAR(touches[0].p_H.y(), 0.035, 1e-12);
  EXPECT_NEAR(touches[0].force_n, 2.0, 1e-12);
}

/// [m] distance of a point from the middle line of the body.
double distance_from(const std::vector<PlanarPose>& body, const RobotModel& robot, const Eigen::Vector2d& p) {
  double least_m = 1e9;
  for (const PlanarPose& module : body) {
    const Eigen::Vector2d local = module.to_local(p);
    const double beyond_m = std::max(std::abs(local.x()) - 0.5 * robot.module_length_m, 0.0);
    least_m = std::min(least_m, std::hypot(beyond_m, local.y()));
  }
  return least_m;
}

// The largest circle inside the U, found by trying all places, is the largest object.
TEST_F(TouchTest, TheLargestObjectFillsTheOpenU) {
  msg::JointState open = joints;
  const auto shape = grip_sense.open_shape(1.0, config.base_angle_rad);
  const std::vector<std::size_t> yaw_joints = robot.yaw_joints();
  for (std::size_t k = 0; k < yaw_joints.size(); ++k) open.position_rad[yaw_joints[k]] = shape[k];
  const auto body = planar_body(robot, open);
  // The mouth is open: places that touch the middle of the base, and lie between the arms, count.
  double largest_m = 0.0;
  const Eigen::Vector2d apex = body[13].p;
  for (double x = -0.3; x <= 0.3; x += 0.002) {
    for (double y = -0.3; y <= 0.3; y += 0.002) {
      const Eigen::Vector2d p = apex + Eigen::Vector2d(x, y);
      const double room_m = distance_from(body, robot, p);
      if (body[13].to_local(p).y() > 0.0 && (p - apex).norm() < room_m + 0.012) largest_m = std::max(largest_m, room_m);
    }
  }
  EXPECT_NEAR(grip_sense.largest_radius_m(), largest_m - robot.module_radius_m, 0.006);
  EXPECT_NEAR(grip_sense.largest_radius_m(), 0.119, 0.001);
}

TEST_F(TouchTest, ContactsOnTheBodyItselfAreNotTouches) {
  // Bent by nearly 90 degrees at three joints in a row, the body touches itself.
  msg::JointState folded = joints;
  for (int j : {4, 6, 8}) folded.position_rad[j] = 1.5;
  const auto body = planar_body(robot, folded);
  // The module far along the body that is nearest to module 2.
  msg::ContactState contacts{};
  contacts.contact_count = 1;
  std::size_t other = 0;
  double nearest_m = 1e9;
  for (std::size_t m = 9; m < body.size(); ++m) {
    if ((body[m].p - body[2].p).norm() < nearest_m) {
      nearest_m = (body[m].p - body[2].p).norm();
      other = m;
    }
  }
  ASSERT_LT(nearest_m, 0.15);
  // A contact on the other module's skin, towards module 2, felt by module 2.
  const Eigen::Vector2d towards = (body[2].p - body[other].p).normalized();
  const Eigen::Vector2d p_H = body[other].p + 0.036 * towards;
  const Eigen::Vector2d p_2 = body[2].to_local(p_H);
  contacts.contacts[0] = contact(2, 0.0, 1.0, 0.0, 3.0);
  contacts.contacts[0].position_m = {p_2.x(), p_2.y(), 0.0};
  EXPECT_TRUE(lateral_touches(robot, body, contacts, 0.4).empty());
}

TEST_F(TouchTest, AHeldObjectLiesBetweenTheArmsOnItsSide) {
  for (const double side : {1.0, -1.0}) {
    const auto body = planar_body(robot, u_joints(side));
    const Eigen::Vector2d p_HO = grip_sense.held_object_H(body, 0.085);
    EXPECT_GT(side * p_HO.y(), 0.1);
    EXPECT_LT(side * p_HO.y(), 0.2);
    EXPECT_LT(p_HO.x(), -0.7);
    // The object touches modules, but does not overlap them: 0.085 m is its radius, 0.035 m is that of a module.
    for (const PlanarPose& module : body) EXPECT_GT((module.p - p_HO).norm(), 0.085 + 0.035 - 0.02);
  }
}

/// A U to the right that holds an object, and the torque of its base.
TEST_F(TouchTest, EachTouchBelongsToTheObjectThatStandsThere) {
  msg::FieldMap map{};
  map.object_count = 3;
  map.objects[0] = {7, msg::kColourGreen, msg::kBlobObject, 1.0, 0.12, 0.08, 0.15, 0.01, false, false, 0, 1.0};
  map.objects[1] = {8, msg::kColourRed, msg::kBlobObject, 1.0, -0.115, 0.08, 0.15, 0.01, false, false, 0, 1.0};
  map.objects[2] = {9, msg::kColourRed, msg::kBlobZone, 0.5, 0.1, 0.08, 0.15, 0.01, false, false, 0, 0.0};
  std::vector<Touch> touches(4);
  touches[0].p_H = {0.0, 0.04};   // the head is at (1, 0): the green one, 0.12 m to the left
  touches[1].p_H = {0.0, -0.04};  // the red one
  touches[2].p_H = {-0.5, 0.03};  // a zone cannot be touched
  touches[3].p_H = {0.35, 0.0};   // nothing is known there
  assign_touches(map, {{1.0, 0.0}, 0.0}, 0.085, touches);
  EXPECT_EQ(touches[0].handle, 7);
  EXPECT_EQ(touches[1].handle, 8);
  EXPECT_EQ(touches[2].handle, 0);
  EXPECT_EQ(touches[3].handle, 0);
  EXPECT_EQ(touches_of(7, touches).size(), 3U) << "all but that of the red object";
  EXPECT_EQ(touches_of(0, touches).size(), 4U);
}

class HoldTest : public TouchTest {
 protected:
  HoldTest() {
    grip.side = -1.0;
    grip.carrying = true;
    grip_sense.hold_starts(grip);
  }
  void load(double torque_nm) {
    for (int j : {10, 12, 14}) u.torque_nm[j] = -torque_nm;
  }
  Grip grip;
  msg::JointState u = u_joints(-1.0);
};

TEST_F(HoldTest, AGraspIsNotLostWhileTheRobotIsNotToMove) {
  load(0.1);
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(grip_sense.watch(u, {}, true, 0.02, grip, false));
  double time_s = 0.0;
  while (!grip_sense.watch(u, {}, true, 0.02, grip) && time_s < 10.0) time_s += 0.02;
  EXPECT_NEAR(time_s, config.lost_after_s, 0.03) << "the while begins when it moves";
}

TEST_F(HoldTest, AGraspIsLostOnlyAfterAWhileWithoutTorqueAndTouch) {
  std::vector<Touch> touch(1);
  touch[0].module = 12;
  touch[0].force_n = 2.0;
  const auto lost_after_s = [&] {
    double time_s = 0.0;
    while (!grip_sense.watch(u, {}, true, 0.02, grip)) {
      time_s += 0.02;
      if (time_s > 10.0) break;
    }
    return time_s;
  };
  load(1.2);  // torque, and a touch in every tenth tick
  for (int i = 0; i < 1000; ++i)
    ASSERT_FALSE(grip_sense.watch(u, i % 10 == 0 ? touch : std::vector<Touch>{}, true, 0.02, grip));
  load(0.1);  // touch without torque
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(grip_sense.watch(u, touch, true, 0.02, grip));
  const double neither_s = lost_after_s();
  EXPECT_GT(neither_s, config.lost_after_s);
  EXPECT_LT(neither_s, 5.0);
  // A large wave loads the base of an empty U as well: torque without any touch is not a hold, but is doubted for
  // longer.
  grip_sense.hold_starts(grip);
  load(1.2);
  const double untouched_s = lost_after_s();
  EXPECT_GT(untouched_s, neither_s + 0.5);
  EXPECT_LT(untouched_s, 6.0);
}

// The friction of the ground on the arms can open the base until the arms point in directions 90 degrees apart. The
// angle is filtered like a first-order lag, which the solution of its equation gives.
TEST_F(HoldTest, ABaseThatTheArmsOpenIsClosedByALargerTorque) {
  std::vector<Touch> touch(1);
  touch[0].module = 12;
  touch[0].force_n = 2.0;
  const auto open_each_rad = [&](double angle_rad) {
    for (int j : {10, 12, 14}) u.position_rad[j] = -std::numbers::pi / 3.0 + angle_rad;
  };
  const auto watch_for_s = [&](double time_s) {
    for (int i = 0; i < std::lround(time_s / 0.02); ++i)
      ASSERT_FALSE(grip_sense.watch(u, touch, true, 0.02, grip)) << "it holds the object all the time";
  };
  grip.shape_rad = grip_sense.hold_shape(u, grip, true);
  grip_sense.hold_starts(grip);
  load(1.5);
  watch_for_s(10.0);
  EXPECT_EQ(grip.hold_torque_nm, config.hold_torque_nm) << "the margin of the command is no opening";
  open_each_rad(-0.3);
  watch_for_s(10.0);
  EXPECT_EQ(grip.hold_torque_nm, config.hold_torque_nm) << "it has closed";
  open_each_rad(0.0);
  watch_for_s(20.0);
  open_each_rad(0.5 * config.opened_rad);  // three joints: one and a half times the bound
  const double after_s = config.lost_filter_s * std::log(1.5 / 0.5);
  watch_for_s(after_s - 0.1);
  EXPECT_EQ(grip.hold_torque_nm, config.hold_torque_nm);
  watch_for_s(0.2);
  EXPECT_EQ(grip.hold_torque_nm, config.closing_torque_nm);
  open_each_rad(0.2 * config.opened_rad);  // 0.6 times the bound
  watch_for_s(20.0);
  EXPECT_EQ(grip.hold_torque_nm, config.closing_torque_nm) << "it is not closed enough";
  open_each_rad(0.1 * config.opened_rad);
  watch_for_s(20.0);
  EXPECT_EQ(grip.hold_torque_nm, config.hold_torque_nm);
}

TEST_F(HoldTest, TheBaseIsNotClosedByMoreThanItsJointsCan) {
  for (JointModel& joint : robot.joints) joint.max_torque_nm = 2.5;
  grip.shape_rad = grip_sense.hold_shape(u, grip, true);
  grip_sense.hold_starts(grip);
  u = u_joints(0.0);
  for (int i = 0; i < 500; ++i) grip_sense.watch(u, {}, true, 0.02, grip);
  EXPECT_EQ(grip.hold_torque_nm, 2.5);
}

TEST_F(HoldTest, ATouchOfAnotherObjectIsNoHold) {
  grip.handle = 3;
  std::vector<Touch> touch(1);
  touch[0].module = 12;
  touch[0].force_n = 2.0;
  touch[0].handle = 4;
  load(0.1);
  double time_s = 0.0;
  while (!grip_sense.watch(u, touch, true, 0.02, grip) && time_s < 10.0) time_s += 0.02;
  EXPECT_LT(time_s, 5.0);
  grip_sense.hold_starts(grip);
  touch[0].handle = 3;
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(grip_sense.watch(u, touch, true, 0.02, grip));
}

TEST_F(HoldTest, ARobotWithoutContactSensorsNoticesTheLossByTheTorque) {
  load(1.4);
  for (int i = 0; i < 1000; ++i) ASSERT_FALSE(grip_sense.watch(u, {}, false, 0.02, grip));
  load(0.1);
  double time_s = 0.0;
  while (!grip_sense.watch(u, {}, false, 0.02, grip) && time_s < 10.0) time_s += 0.02;
  EXPECT_GT(time_s, config.lost_after_s);
  EXPECT_LT(time_s, 5.0);
}

TEST_F(TouchTest, ThePathErrorIsTheLateralPositionOfThePathAhead) {
  const PlanarPose X_MH{{0.0, -0.2}, 0.0};
  EXPECT_NEAR(path_error_m(X_MH, {5.0, 0.0}, 0.0, 0.3), 0.2, 1e-12);       // path to the left
  EXPECT_LT(path_error_m({{0.0, 0.0}, 0.5}, {0.0, 0.0}, 0.0, 0.3), -0.1);  // head turned left of the path
}

}  // namespace
}  // namespace constrictor
