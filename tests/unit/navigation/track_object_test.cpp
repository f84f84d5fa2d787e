// track_object with a body that bends and slides as the gait intends: from any place near the object it reaches the
// object without moving to and fro.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <string>

#include "barrier/local_run.hpp"
#include "navigation/navigation.hpp"
#include "robot/planar.hpp"
#include "robot/trajectory_path.hpp"
#include "support/project.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {
namespace {

constexpr double kDrivenSpeed_m_s = 0.4;
constexpr double kModule_m = 0.089;
constexpr int kModules = 24;
constexpr double kObjectRadius_m = 0.085;
constexpr double kCurvatureShare = 0.8;  ///< the path of an undulating head is less curved than commanded

/// A body that bends into an arc of the commanded curvature, as control bends it, and slides along this arc.
struct BendingBody {
  PlanarPose X_MC;             ///< centre of the body; its heading is the mean heading
  double curvature_1_m = 0.0;  ///< positive to the left

  void drive(double step_m, double wanted_1_m, double dt_s) {
    constexpr double kRate_1_ms = 1.5;
    curvature_1_m += std::clamp(wanted_1_m - curvature_1_m, -kRate_1_ms * dt_s, kRate_1_ms * dt_s);
    const double turn_rad = curvature_1_m * step_m;
    X_MC.p += turned({step_m, 0.0}, X_MC.yaw_rad + 0.5 * turn_rad);
    X_MC.yaw_rad += turn_rad;
  }
  /// Heading in M at a place of the body, counted from the head.
  [[nodiscard]] double yaw_rad(int module) const {
    return X_MC.yaw_rad + curvature_1_m * kModule_m * (0.5 * (kModules - 1) - module);
  }
  [[nodiscard]] PlanarPose head() const {
    Eigen::Vector2d p(0.0, 0.0);
    Eigen::Vector2d mean(0.0, 0.0);  // of the modules, from the head
    for (int m = 0; m < kModules; ++m) {
      mean += p / kModules;
      p -= kModule_m * along(yaw_rad(m));
    }
    return {X_MC.p - mean, yaw_rad(0)};
  }
};

/// A run of track_object of a straight body with the object at `p_HO` in the frame of its head.
class TrackRun {
 public:
  explicit TrackRun(const Eigen::Vector2d& p_HO) : p_MO_(body_->head().p + p_HO), run_(members(), setup()) {
    run_.subscribe<msg::TaskEvent>(topics::kTaskEvent, [this](const msg::TaskEvent& event) {
      if (event.event == msg::kEventObjectReached) reached_ = true;
      if (event.goal_state == msg::kGoalAborted) aborted_ = true;
    });
    run_.subscribe<msg::TaskStatus>(topics::kTaskStatus, [this](const msg::TaskStatus& status) {
      const std::string phase = status.phase;
      const bool leaving = phase == "leave" || phase == "back off";
      if (leaving && !leaving_) ++leaves_;
      leaving_ = leaving;
    });
  }
  /// Runs until the task has ended, but at most `limit_s`. Returns the simulated time.
  double run(double limit_s) {
    double time_s = 0.0;
    for (; time_s < limit_s && !reached_ && !aborted_; time_s += 1.0) run_.advance(50);
    return time_s;
  }
  [[nodiscard]] bool reached() const { return reached_; }
  [[nodiscard]] int leaves() const { return leaves_; }

 private:
  static Setup setup() {
    Setup setup;
    setup.robot_file = testing::robot_path("mamba");
    return setup;
  }

  std::vector<ComponentFactory> members() {
    const auto joints = testing::scripted_plant([this](Wiring& wiring) -> testing::StepFunction {
      return [this, out = wiring.output(topics::kJointState),
              contacts = wiring.output(topics::kContactState)](const Tick&) {
        msg::JointState state{};
        state.joint_count = kModules - 1;
        // The even joints are the yaw joints. Joint j is between module j and module j + 1.
        for (int j = 0; j + 1 < kModules; j += 2) {
          const int last = std::min(j + 2, kModules - 1);
          state.position_rad[j] = body_->yaw_rad(j) - body_->yaw_rad(last);
        }
        out.write(state);
        contacts.write(msg::ContactState{});
      };
    });
    const auto guidance = testing::scripted_member("guidance", [this](Wiring& wiring) -> testing::StepFunction {
      return [this, desired = wiring.latest(topics::kDesiredTrajectory), out = wiring.output(topics::kRobotPose),
              map_out = wiring.output(topics::kFieldMap)](const Tick& tick) {
        if (desired && std::string(desired->motion) == "travel") {
          const double step_m = std::copysign(kDrivenSpeed_m_s, desired->speed_m_s) * tick.dt_s();
          body_->drive(step_m, kCurvatureShare * pursuit_curvature_1_m(*desired, 0.35), tick.dt_s());
        }
        const PlanarPose head = body_->head();
        msg::RobotPose pose{};
        pose.x_m = head.p.x();
        pose.y_m = head.p.y();
        pose.yaw_rad = wrap_angle(head.yaw_rad);
        out.write(pose);
        if (tick.index % 5 != 0) return;
        msg::FieldMap map{};
        map.object_count = 1;
        map.objects[0] = {1,
                          msg::kColourGreen,
                          msg::kBlobObject,
                          p_MO_.x(),
                          p_MO_.y(),
                          kObjectRadius_m,
                          0.15,
                          0.03,
                          false,
                          false,
                          tick.index,
                          1.0};
        map_out.write(map);
      };
    });
    const auto eyes = testing::scripted_writer<msg::ObjectPercepts>(
        "perception", topics::kObjectPercepts, [this](const Tick& tick, const auto& out) {
          if (tick.index % 5 != 0) return;
          msg::ObjectPercepts percepts{};
          percepts.exposure_tick = tick.index;
          const Eigen::Vector2d p_HO = body_->head().to_local(p_MO_);
          const double bearing_rad = std::atan2(p_HO.y(), p_HO.x());
          // The robot has seen the object before the task begins, wherever it is.
          const bool seen = std::abs(bearing_rad) < 0.75 || tick.index < 100;
          percepts.blob_count = seen ? 1 : 0;
          msg::Blob& blob = percepts.blobs[0];
          blob.colour = msg::kColourGreen;
          blob.kind = msg::kBlobObject;
          blob.bearing_rad = bearing_rad;
          blob.range_m = p_HO.norm() - kObjectRadius_m;
          blob.width_m = 2.0 * kObjectRadius_m;
          blob.area_fraction = 0.01;
          out.write(percepts);
        });
    const auto input = testing::scripted_writer<msg::TaskCommand>(
        "input", topics::kTaskCommand, [](const Tick& tick, const auto& out) {
          if (tick.index != 100) return;
          msg::TaskCommand command{};
          command.goal_id = 1;
          command.task = msg::kTaskTrackObject;
          command.parameters.timeout_s = std::numeric_limits<double>::quiet_NaN();
          command.parameters.object_colour = msg::kColourGreen;
          out.write(command);
        });
    return {joints, make_navigation_factory(), guidance, eyes, input};
  }

  std::shared_ptr<BendingBody> body_ = std::make_shared<BendingBody>();
  Eigen::Vector2d p_MO_;
  LocalRun run_;
  bool reached_ = false, aborted_ = false, leaving_ = false;
  int leaves_ = 0;
};

TEST(TrackObject, ReachesTheObjectFromAnywhereWithoutMovingToAndFro) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> distances_m(0.3, 2.0);
  std::uniform_real_distribution<double> bearings_rad(-std::numbers::pi, std::numbers::pi);
  int reached = 0;
  double longest_s = 0.0;
  constexpr int kStarts = 60;
  for (int i = 0; i < kStarts; ++i) {
    const double distance_m = distances_m(random);
    const double bearing_rad = bearings_rad(random);
    TrackRun run(distance_m * Eigen::Vector2d(std::cos(bearing_rad), std::sin(bearing_rad)));
    const double time_s = run.run(90.0);
    reached += run.reached();
    longest_s = std::max(longest_s, time_s);
    EXPECT_LE(run.leaves(), 2) << "object at " << distance_m << " m, " << bearing_rad << " rad, " << time_s << " s";
    EXPECT_TRUE(run.reached()) << "object at " << distance_m << " m, " << bearing_rad << " rad";
  }
  RecordProperty("longest_s", std::to_string(longest_s));
  EXPECT_EQ(reached, kStarts);
  EXPECT_LT(longest_s, 30.0);
}

}  // namespace
}  // namespace constrictor
