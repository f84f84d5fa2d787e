// Tables VII to XII (pregrasp, grasp, drop) with simulated contact: an object is pregrasped, grasped, carried and
// dropped. When a scripted force takes the object away, navigation must notice the loss by torque and touch.
#include <stdexcept>

#include "behaviour_run.hpp"

namespace constrictor::testing {
namespace {

constexpr double kRadius_m = 0.085;
constexpr double kModuleRadius_m = 0.035;

std::string scene(const std::string& more = "") {
  return "name: one\nobjects: [{colour: green, frame: world, position_m: [1.2, 0.15], shape: cylinder, radius_m: "
         "0.085, "
         "height_m: 0.15, mass_kg: 0.4}]\nzones: [{colour: green, frame: world, position_m: [-0.9, 0.5], radius_m: "
         "0.35}]\n"
         "start: {frame: world, position_m: [0, 0]}\nnoise: {sensors: true, camera_sd: 0.01}\n" +
         more;
}

/// The same scene with another cylinder.
std::string scene_with(double radius_m, double height_m, double mass_kg) {
  const std::string usual = "radius_m: 0.085, height_m: 0.15, mass_kg: 0.4";
  std::string text = scene();
  const std::size_t at = text.find(usual);
  if (at == std::string::npos) throw std::logic_error("the scene has no '" + usual + "'");
  return text.replace(at, usual.size(),
                      "radius_m: " + std::to_string(radius_m) + ", height_m: " + std::to_string(height_m) +
                          ", mass_kg: " + std::to_string(mass_kg));
}

class GraspEvents : public Behaviour {
 protected:
  void pregrasp() {
    start_green(msg::kTaskSearchObject);
    ASSERT_EQ(until_end(20.0), msg::kGoalSucceeded);
    start_green(msg::kTaskPregrasp);
    ASSERT_EQ(until_end(90.0), msg::kGoalSucceeded);
    ASSERT_TRUE(first(msg::kEventObjectPregrasped));
  }
  void grasp() {
    pregrasp();
    start(msg::kTaskGrasp, [](msg::TaskParameters&) {});
    ASSERT_TRUE(until_event(msg::kEventObjectGrasped, 90.0));
  }
  /// [Nm] mean torque of the yaw joints in the base of the U: joints 10, 12 and 14, by navigation's `base_first_joint`
  /// and `base_joints`. The sign is the side to which the base presses.
  [[nodiscard]] double base_torque_nm() const {
    const auto& joints = *run_->latest(topics::kJointState);
    return (joints.torque_nm[10] + joints.torque_nm[12] + joints.torque_nm[14]) / 3.0;
  }
  double mean_base_torque_nm(double over_s) {
    double sum = 0.0;
    int count = 0;
    until(
        [&] {
          sum += base_torque_nm();
          ++count;
          return false;
        },
        over_s);
    return sum / count;
  }
  /// [rad] angle by which the body is wrapped around the object, from the tail to the head; positive: counterclockwise.
  [[nodiscard]] double wound_rad() const {
    double sum_rad = 0.0;
    for (std::size_t m = world().module_count - 1; m > 0; --m) {
      const Place from_object{object().x_m, object().y_m, 0.0};
      sum_rad += wrap_angle(from_object.bearing_rad(module(m - 1)) - from_object.bearing_rad(module(m)));
    }
    return sum_rad;
  }
};

TEST_F(GraspEvents, GraspsCarriesAndDropsAnObjectOnItsZone) {
  begin(scene());
  pregrasp();
  ASSERT_FALSE(HasFatalFailure());
  // The object stands beside the body within reach of the wrap, and the body has touched it.
  std::printf("pregrasped: %.3f m from the body, wound %.2f rad\n", nearest_module_m(), wound_rad());
  EXPECT_LT(nearest_module_m(), kRadius_m + kModuleRadius_m + 0.15);
  EXPECT_GT(object_touched_s, 0.0);
  const std::uint16_t handle = first(msg::kEventObjectPregrasped)->event.object_handle;
  ASSERT_GT(handle, 0);
  EXPECT_EQ(handle, mapped_handle(msg::kColourGreen));

  start(msg::kTaskGrasp, [&](msg::TaskParameters& p) { p.object_handle = handle + 1; });
  EXPECT_EQ(until_end(1.0), msg::kGoalRefused) << "another object is pregrasped";
  start(msg::kTaskGrasp, [&](msg::TaskParameters& p) { p.object_handle = handle; });
  ASSERT_TRUE(until_event(msg::kEventObjectGrasped, 90.0));
  const Happened grasped = *first(msg::kEventObjectGrasped);
  EXPECT_EQ(grasped.event.object_handle, handle);
  std::printf("grasped: wound %.2f rad\n", wound_rad());
  EXPECT_GT(std::abs(wound_rad()), 4.0) << "the body goes round the object by more than half a turn";
  EXPECT_LT(nearest_module_m(), kRadius_m + kModuleRadius_m + 0.02);
  EXPECT_NEAR(object_touched_s, grasped.time_s, 1.0);

  start(msg::kTaskExplore, &msg::TaskParameters::direction, msg::kDirectionForwards);  // until the zone is in view
  until([&] { return in_view(head(), {-0.9, 0.5, 0.0}, 1.8); }, 20.0);
  const double torque_nm = mean_base_torque_nm(1.0);
  start(msg::kTaskDrop, &msg::TaskParameters::drop_zone_colour, msg::kColourGreen);
  ASSERT_TRUE(until_event(msg::kEventDroppingDone, 150.0));
  EXPECT_FALSE(first(msg::kEventObjectGraspLost));
  const Happened dropped = *first(msg::kEventDroppingDone);
  EXPECT_EQ(dropped.event.object_handle, handle);
  const double away_m = dropped.object.distance_m({-0.9, 0.5, 0.0});
  std::printf("dropped %.2f m from the zone's centre, %.2f m from the body; base torque while carried %.2f Nm\n",
              away_m, nearest_module_m(), torque_nm);
  EXPECT_GT(grasped.object.distance_m(dropped.object), 1.0);
  EXPECT_LT(away_m, 0.35);
  EXPECT_NEAR(world().object_poses[0].position_m.z, 0.075, 0.01) << "it stands upright";
  EXPECT_GT(nearest_module_m(), kRadius_m + kModuleRadius_m + 0.05) << "the robot has left it";
  EXPECT_LT(object_touched_s, dropped.time_s - 1.0);
  EXPECT_GT(std::abs(torque_nm), 0.5) << "the base must press on a carried object";
}

// The zone is farther away than the time limit allows: the robot keeps the object and does not drop it elsewhere.
TEST_F(GraspEvents, KeepsTheObjectWhenItsZoneIsNotReachedInTime) {
  begin(scene());
  grasp();
  ASSERT_FALSE(HasFatalFailure());
  start(msg::kTaskExplore, &msg::TaskParameters::direction, msg::kDirectionForwards);
  until([&] { return in_view(head(), {-0.9, 0.5, 0.0}, 1.8); }, 20.0);
  start(msg::kTaskDrop, [](msg::TaskParameters& p) {
    p.drop_zone_colour = msg::kColourGreen;
    p.timeout_s = 2.0;
  });
  EXPECT_EQ(until_end(10.0), msg::kGoalAborted);
  EXPECT_FALSE(first(msg::kEventDroppingDone));
  EXPECT_TRUE(run_->latest(topics::kTaskStatus)->carrying);
}

// An object nearly as wide as the U with parallel arms (0.119 m) wedges between the arms before it reaches the base.
TEST_F(GraspEvents, GraspsALargeObjectAtTheFirstAttempt) {
  begin(scene_with(0.117, 0.15, 0.9));
  grasp();
  EXPECT_FALSE(first(msg::kEventObjectGraspLost));
  EXPECT_GT(std::abs(wound_rad()), 4.0);
}

// The usual gait knocks such an object over within a metre: it tips at 4.8 m/s^2, and the arms move with 7.3 m/s^2.
TEST_F(GraspEvents, CarriesATallAndNarrowObjectUpright) {
  constexpr double kHeight_m = 0.22;
  begin(scene_with(0.054, kHeight_m, 0.6));
  grasp();
  ASSERT_FALSE(HasFatalFailure());
  const Place from = object();
  start(msg::kTaskExplore, &msg::TaskParameters::direction, msg::kDirectionForwards);
  EXPECT_TRUE(until([&] { return object().distance_m(from) > 1.2; }, 60.0)) << object().distance_m(from);
  EXPECT_NEAR(world().object_poses[0].position_m.z, 0.5 * kHeight_m, 0.01) << "it stands upright";
  EXPECT_TRUE(run_->latest(topics::kTaskStatus)->carrying);
}

// A force throws the object away when it has been pushed by 0.2 m, which happens at the end of the wrap.
TEST_F(GraspEvents, ReportsGraspLostWhenTheObjectLeavesTheClosingBody) {
  begin(scene("perturbations: [{object: 0, when_displaced_m: 0.2, duration_s: 0.3, force_n: [6, 0, 25]}]\n"));
  pregrasp();
  ASSERT_FALSE(HasFatalFailure());
  EXPECT_LT(object().distance_m({1.2, 0.15, 0.0}), 0.2);
  start(msg::kTaskGrasp, [](msg::TaskParameters&) {});
  ASSERT_TRUE(until_event(msg::kEventObjectGraspLost, 120.0));
  EXPECT_FALSE(first(msg::kEventObjectGrasped));
  EXPECT_GT(nearest_module_m(), 1.0);
  EXPECT_EQ(until_end(1.0), msg::kGoalAborted);
}

TEST_F(GraspEvents, ReportsGraspLostByTorqueAndTouchWhenACarriedObjectIsTakenAway) {
  begin(
      scene("perturbations: [{object: 0, when_displaced_m: 1.8, duration_s: 0.3, force_n: [0, 0, 40]}, "
            "{object: 0, when_displaced_m: 1.8, duration_s: 0.6, force_n: [-15, 0, 0]}]\n"));
  grasp();
  ASSERT_FALSE(HasFatalFailure());
  start(msg::kTaskExplore, &msg::TaskParameters::direction, msg::kDirectionForwards);
  const double held_nm = mean_base_torque_nm(3.6);  // four periods of the gait
  EXPECT_GT(std::abs(held_nm), 0.5);
  ASSERT_TRUE(until(
      [&] {
        return object().distance_m({1.2, 0.15, 0.0}) > 1.8;
      },
      60.0))
      << object().distance_m({1.2, 0.15, 0.0});
  const double thrown_s = time_s();
  ASSERT_FALSE(first(msg::kEventObjectGraspLost));
  const double side = std::copysign(1.0, held_nm);
  double torque_nm = held_nm;
  double least_nm = side * held_nm;
  ASSERT_TRUE(until(
      [&] {
        torque_nm += 0.02 * (base_torque_nm() - torque_nm);  // a low-pass with a time constant of one second
        least_nm = std::min(least_nm, side * torque_nm);
        return first(msg::kEventObjectGraspLost) != nullptr;
      },
      15.0));
  const Happened& lost = *first(msg::kEventObjectGraspLost);
  std::printf(
      "base torque %.2f Nm; thrown at %.2f s, last touched at %.2f s, lost at %.2f s, least base torque %.2f Nm\n",
      held_nm, thrown_s, object_touched_s, lost.time_s, least_nm);
  EXPECT_GT(lost.time_s, thrown_s);
  EXPECT_GT(lost.time_s, object_touched_s + 2.0) << "navigation's `lost_after_s`";
  // The wave of the gait loads the empty base, too, in some of its phases as much as the object did.
  EXPECT_LT(least_nm, 0.5 * std::abs(held_nm));
  EXPECT_GT(lost.head.distance_m(lost.object), 0.5);
  EXPECT_EQ(until_end(1.0), msg::kGoalAborted);
}

}  // namespace
}  // namespace constrictor::testing
