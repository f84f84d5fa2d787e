// drop: where it lets the object go, and how it backs off with a body that has slid aside, as it does on a slope.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "robot/planar.hpp"
#include "task_setting.hpp"

namespace constrictor {
namespace {

constexpr double kSway_hz = 1.1;  // of the gait by which the robot backs off
constexpr double kBacking_m_s = 0.15;
constexpr double kDropped_m = 0.085;  // radius of the object

/// A U whose mouth points along x. It lets its object go at the origin of M, and backs off along x, beside this axis.
class DropRun {
 public:
  /// `side`: +1 if the head's part of the body has the object to its left. `aside_m`: mean place of the U along y while
  /// it backs off. `sway_m`: by which it sways about that place with the gait.
  DropRun(double side, double aside_m, double sway_m) : aside_m_(aside_m), sway_m_(sway_m) {
    grip_.carrying = true;
    grip_.side = side;
    grip_.radius_m = kDropped_m;
    grip_.shape_rad = setting_.sense.open_shape(side, setting_.config.grip.base_angle_rad);
    take(grip_.shape_rad);
    setting_.sightings.zones[msg::kColourGreen].known = true;  // its centre is the object's place
    setting_.sway_period_s = 1.0 / kSway_hz;
    setting_.parameters.drop_zone_colour = msg::kColourGreen;
    task_->start(input(), grip_);
  }

  /// [m] Drives along x to the zone, which is 1 m ahead and has a radius of 0.5 m, and returns how far the object is
  /// from its centre when it is let go, positive beyond it. `other_m`: place along x of another object, from the
  /// centre.
  double let_go_m(std::optional<double> other_m) {
    Sighting& zone = setting_.sightings.zones[msg::kColourGreen];
    zone.x_m = 1.0;
    zone.radius_m = 0.5;
    task_->start(input(), grip_);
    if (other_m) add_object({1.0 + *other_m, 0.0});
    while (phase_ != "stop" && setting_.tick.index < 2000) {
      X_MU_.p.x() += kBacking_m_s * setting_.tick.period_s();
      step();
    }
    return X_MU_.p.x() - 1.0;
  }
  /// How a U drives whose base holds an object.
  struct Drive {
    double heading_rad;  ///< at the beginning; the zone lies along x
    double turns;        ///< turn of the U for each unit of curvature and distance
    double bias_1_m;     ///< curvature at which it drives straight on
    double crab_rad;     ///< from its direction to that of its motion
  };
  /// [m] Drives over the zone, 2.5 m ahead, and returns how far beside its centre the object is let go, without the
  /// sway of the gait.
  double aside_m(const Drive& drive) {
    constexpr double kDrives_m_s = 0.165, kBefore_m = 0.3;  // turns of the U swing the object about the pivot
    Sighting& zone = setting_.sightings.zones[msg::kColourGreen];
    zone.x_m = 2.5;
    zone.radius_m = 0.4;
    task_->start(input(), grip_);
    double heading_rad = drive.heading_rad, curvature_1_m = 0.0;
    Eigen::Vector2d pivot = kBefore_m * along(heading_rad), mean(0.0, 0.0);
    while (phase_ != "stop" && setting_.tick.index < 2000) {
      const double way_m = kDrives_m_s * setting_.tick.period_s();
      heading_rad += drive.turns * (curvature_1_m - drive.bias_1_m) * way_m;
      pivot += way_m * along(heading_rad + drive.crab_rad);
      const double phase_rad = 2.0 * std::numbers::pi * kSway_hz * setting_.tick.time_s();
      mean = pivot - kBefore_m * along(heading_rad);
      X_MU_ = {mean + 0.05 * std::sin(phase_rad) * along(heading_rad + 0.5 * std::numbers::pi),
               heading_rad + 0.2 * std::cos(phase_rad)};
      curvature_1_m = step();
    }
    return std::abs(mean.y());
  }
  /// Adds another object to the map. `p_M`: [m] its place; the robot lets its own go at the origin and backs off to -x.
  void add_object(const Eigen::Vector2d& p_M) {
    msg::MapObject& object = setting_.map.objects[setting_.map.object_count++];
    object.handle = 9;
    object.x_m = p_M.x();
    object.y_m = p_M.y();
    object.radius_m = kDropped_m;
  }
  /// Runs until the robot has backed off.
  void run() {
    while (phase_ != "straighten" && setting_.tick.index < 2000) step();
  }
  [[nodiscard]] const std::string& phase() const { return phase_; }
  /// [m] by which the robot has backed off.
  [[nodiscard]] double backed_m() const { return backed_m_; }
  /// [1/m] largest and least curvature of the arms after the first period of the gait, positive left.
  [[nodiscard]] double most_1_m() const { return most_1_m_; }
  [[nodiscard]] double least_1_m() const { return least_1_m_; }

 private:
  [[nodiscard]] PlanarPose head() const {
    const PlanarPose X_HU{setting_.sense.held_object_H(setting_.body, kDropped_m),
                          setting_.sense.mouth_rad(setting_.body)};
    const double yaw_rad = X_MU_.yaw_rad - X_HU.yaw_rad;
    return {X_MU_.p - turned(X_HU.p, yaw_rad), yaw_rad};
  }
  [[nodiscard]] TaskInput input() const { return setting_.input(head()); }
  void take(const std::array<double, msg::kMaxJoints>& shape_rad) {
    const std::vector<std::size_t> yaw = setting_.robot.yaw_joints();
    setting_.joints.joint_count = static_cast<std::uint16_t>(setting_.robot.joints.size());
    for (std::size_t k = 0; k < yaw.size(); ++k) setting_.joints.position_rad[yaw[k]] = shape_rad[k];
    setting_.body = planar_body(setting_.robot, setting_.joints);
  }
  /// [1/m] One step of the task; returns the curvature of the path.
  double step() {
    setting_.next_tick();
    TaskOutput output;
    task_->step(input(), grip_, output);
    phase_ = output.phase;
    if (phase_ == "open") take(setting_.sense.open_shape(grip_.side, setting_.config.drop.open_angle_rad));
    const double curvature_1_m = output.desired.points[0].curvature_1_m;
    if (phase_ != "back off") return curvature_1_m;
    EXPECT_LT(output.desired.speed_m_s, 0.0) << "it drives backwards";
    const double back_s = backed_m_ / kBacking_m_s;
    if (back_s > 1.0 / kSway_hz) {
      most_1_m_ = std::max(most_1_m_, curvature_1_m);
      least_1_m_ = std::min(least_1_m_, curvature_1_m);
    }
    backed_m_ += kBacking_m_s * setting_.tick.dt_s();
    const double phase_rad = 2.0 * std::numbers::pi * kSway_hz * back_s;
    X_MU_.p = {-backed_m_, aside_m_ + sway_m_ * std::sin(phase_rad)};
    return curvature_1_m;
  }

  const double aside_m_, sway_m_;
  TaskSetting setting_;
  const std::unique_ptr<Task> task_ = make_task(msg::kTaskDrop);
  Grip grip_;
  PlanarPose X_MU_;  ///< at the place of a held object; x points to the mouth
  double backed_m_ = 0.0, most_1_m_ = -1e9, least_1_m_ = 1e9;
  std::string phase_;
};

// The robot pushed the first object off the zone when it brought the second one of the same colour to the centre.
TEST(Drop, TheObjectIsLetGoBeforeAnotherOneThatStandsOnTheZone) {
  const double brake_m = NavigationConfig().drop.brake_m, room_m = NavigationConfig().drop.room_m;
  EXPECT_NEAR(DropRun(1.0, 0.0, 0.0).let_go_m({}), -brake_m, 0.02);
  EXPECT_NEAR(DropRun(1.0, 0.0, 0.0).let_go_m(0.05), 0.05 - 2.0 * kDropped_m - room_m - brake_m, 0.02);
  EXPECT_NEAR(DropRun(1.0, 0.0, 0.0).let_go_m(-0.1), -0.25 - brake_m, 0.02) << "well inside the zone";
  EXPECT_NEAR(DropRun(1.0, 0.0, 0.0).let_go_m(0.4), -brake_m, 0.02) << "not in the way";
}

// In missions the object passed the zone up to 0.35 m aside while the course turned with its bearing of the zone.
TEST(Drop, TheObjectIsLedOverTheCentreOfTheZone) {
  for (const double side : {1.0, -1.0}) {
    for (const double heading_rad : {0.0, 0.4, -0.4}) {
      for (const double turns : {1.0, 2.5}) {
        const DropRun::Drive straight{heading_rad, turns, 0.0, 0.0}, biased{heading_rad, turns, 0.3, 0.0},
            slope{heading_rad, turns, 0.0, 0.2};
        EXPECT_LT(DropRun(side, 0.0, 0.0).aside_m(straight), 0.04) << heading_rad << ", " << turns;
        EXPECT_LT(DropRun(side, 0.0, 0.0).aside_m(biased), 0.08) << heading_rad << ", " << turns;
        EXPECT_LT(DropRun(side, 0.0, 0.0).aside_m(slope), 0.04) << heading_rad << ", " << turns;
      }
    }
  }
}

TEST(Drop, TheArmsStayStraightWhileTheObjectIsInTheMiddle) {
  for (const double side : {1.0, -1.0}) {
    DropRun level(side, 0.0, 0.03);  // the sway of the gait does not bend them
    level.run();
    ASSERT_EQ(level.phase(), "straighten");
    EXPECT_NEAR(level.most_1_m(), 0.0, 0.03) << side;
    EXPECT_NEAR(level.least_1_m(), 0.0, 0.03) << side;
    EXPECT_NEAR(level.backed_m(), NavigationConfig().drop.back_m, 0.05) << side;
  }
}

// The rear arm pushed the first object by 0.3 m when the robot straightened after the drop of the second one.
TEST(Drop, TheRobotBacksOffFartherIfItsArmsWouldPushAnotherObject) {
  const double back_m = NavigationConfig().drop.back_m;
  for (const double y_m : {0.6, -0.6}) {
    DropRun near(1.0, 0.0, 0.0), beyond(1.0, 0.0, 0.0), behind(1.0, 0.0, 0.0), all_round(1.0, 0.0, 0.0);
    near.add_object({-0.4, y_m});
    near.run();
    EXPECT_GT(near.backed_m(), back_m + 0.05) << y_m;
    EXPECT_LT(near.backed_m(), 1.5 * back_m) << "no farther than needed; " << y_m;
    beyond.add_object({0.5, y_m});
    beyond.run();
    EXPECT_NEAR(beyond.backed_m(), back_m, 0.05) << "out of reach; " << y_m;
    behind.add_object({-back_m - 0.5, y_m});
    behind.run();
    EXPECT_NEAR(behind.backed_m(), back_m, 0.05) << "behind the base, where the arms do not sweep; " << y_m;
    for (const double x_m : {-0.3, -0.6, -0.9}) all_round.add_object({x_m, y_m});
    all_round.add_object({-1.4, y_m});
    all_round.run();
    EXPECT_LT(all_round.backed_m(), 1.5 * back_m + 0.05) << "not for ever; " << y_m;
  }
}

TEST(Drop, WhenTheBodySlidesAsideTheArmsBendTowardsTheObject) {
  for (const double side : {1.0, -1.0}) {
    double least_1_m = 0.0;
    for (const double aside_m : {0.02, 0.05, 0.1}) {
      DropRun left(side, aside_m, 0.02), right(side, -aside_m, 0.02);
      left.run();
      right.run();
      ASSERT_EQ(left.phase(), "straighten");
      // The body has slid to the left: the object is to its right, where the curvature is negative.
      EXPECT_LT(left.most_1_m(), -least_1_m - 0.05) << side << ", " << aside_m;
      EXPECT_GT(right.least_1_m(), least_1_m + 0.05) << side << ", " << aside_m;
      EXPECT_NEAR(left.least_1_m(), -right.most_1_m(), 0.05) << "alike on both sides; " << side << ", " << aside_m;
      least_1_m = right.most_1_m();
    }
  }
}

TEST(Drop, TheArmsDoNotBendBeyondTheLimit) {
  DropRun far(1.0, 1.0, 0.0);
  far.run();
  EXPECT_EQ(far.least_1_m(), -NavigationConfig().drop.back_steering.limit);
}

}  // namespace
}  // namespace constrictor
