// Drop (Tables XI, XII): the robot drives over the drop zone of a colour until the zone has left the view, continues
// until the held object is over the zone's centre, stops, opens the U, backs off, straightens, and backs off farther.
// The body sweeps the ground when it turns later; what was dropped must be out of its reach.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "navigation/held_motion.hpp"
#include "navigation/motions.hpp"
#include "navigation/pid.hpp"
#include "navigation/steering.hpp"
#include "robot/landmarks.hpp"
#include "robot/planar.hpp"

namespace constrictor {
namespace {

struct DropState : PhaseState {
  Eigen::Vector2d p_MZ{0.0, 0.0};
  double course_rad = 0.0;  ///< heading in M of the straight course over the zone
  PidState steering;
  HeldMotion object;
  PlanarPose from;                 ///< the head when the phase began
  Eigen::Vector2d p_MO{0.0, 0.0};  ///< where the object was let go
  SteeringState back;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(phase, phase_s, p_MZ.x(), p_MZ.y(), course_rad, steering, object, from, p_MO.x(), p_MO.y(), back);
  }
};

class Drop : public StatefulTask<DropState> {
  enum Phase : int { kApproach, kOver, kStop, kOpen, kBack, kStraighten, kClear };
  static constexpr double kFarther = 1.5;  ///< times back_m: the robot backs off as far if its arms reach an object

 public:
  /// The zone has a place in the map, and the object is let go by touch.
  [[nodiscard]] bool steers_by_sight() const override { return false; }
  [[nodiscard]] bool keeps_time() const override { return true; }
  std::string refusal(const TaskInput& input, const Grip& grip) const override {
    if (!grip.carrying) return "drop cannot run: the robot carries no object";
    if (!input.sightings.zones[input.parameters.drop_zone_colour].known)
      return "no drop zone of this colour was seen yet";
    return "";
  }
  // The course is a straight line, which stays: the object swings out when the U turns, so that a course that followed
  // the object's bearing of the zone would turn with it, and the object would pass the zone on an arc.
  void start(const TaskInput& input, Grip& grip) override {
    state_.p_MZ = input.sightings.zones[input.parameters.drop_zone_colour].p_M();
    const Eigen::Vector2d d = state_.p_MZ - object_M(input, grip);
    state_.course_rad = std::atan2(d.y(), d.x());
  }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    state_.phase_s += input.tick.dt_s();
    output.progress = state_.phase / 7.0;
    run_phase<Drop, 7>(
        *this, {&Drop::drive, &Drop::drive, &Drop::stop, &Drop::open, &Drop::back, &Drop::straighten, &Drop::clear},
        state_.phase, input, grip, output);
  }

 private:
  void enter(const TaskInput& input, int phase) {
    state_.enter(phase);
    state_.from = input.X_MH;
  }

  /// [m] The held object's centre in M.
  [[nodiscard]] static Eigen::Vector2d object_M(const TaskInput& input, const Grip& grip) {
    return input.X_MH.to_parent(input.grip_sense.held_object_H(input.body, grip.radius_m));
  }

  void drive(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const DropConfig& config = input.config.drop;
    const Sighting& zone = input.sightings.zones[input.parameters.drop_zone_colour];
    if (zone.missed == 0) {
      state_.p_MZ = zone.p_M();
    } else if (state_.phase == kApproach && !zone.visible) {
      enter(input, kOver);
    }
    output.phase = state_.phase == kApproach ? "approach" : "over the zone";
    const double mouth_rad = input.X_MH.yaw_rad + input.grip_sense.mouth_rad(input.body);
    const HeldMotion::Motion object =
        state_.object.observe(input.tick.time_s(), object_M(input, grip), mouth_rad, input.sway_period_s,
                              {config.pivot_m, config.crab_filter_s});
    const Eigen::Vector2d& p_MO = object.place;
    const PlanarPose X_MC{state_.p_MZ, state_.course_rad};  // the course through the zone's centre
    // The point that steers lies ahead of the object, in the direction in which the U drives, so that its distance from
    // the course contains both the object's distance and the angle between drive and course.
    const double driving_rad = object.heading_rad + object.crab_rad;
    const double error_m = -X_MC.to_local(p_MO + config.lookahead_m * along(driving_rad)).y();
    move_carefully(input, pid_step(config.steering, error_m, input.tick.dt_s(), state_.steering), 1.0, grip, output);
    const double past_m = X_MC.to_local(p_MO).x();
    if (input.run_s > time_limit_s(input.parameters))
      return output.abort("the zone was not reached in time");  // the robot still holds the object
    if (past_m >= stop_m(input, grip, X_MC) - config.brake_m) {
      enter(input, kStop);
      stand(grip, output);
    }
  }

  /// [m] Place on the course, counted from the zone's centre, at which the object is to stand: at the centre, or before
  /// another object that stands in its way there, but always well inside the zone.
  [[nodiscard]] static double stop_m(const TaskInput& input, const Grip& grip, const PlanarPose& X_MC) {
    constexpr double kInside = 0.5;  // of the zone's radius
    const double zone_m = input.sightings.zones[input.parameters.drop_zone_colour].radius_m;
    double at_m = 0.0;
    for (const msg::MapObject& other : input.map ? landmarks_of(*input.map) : std::span<const msg::MapObject>{}) {
      if (!is_another_object(other, grip)) continue;
      const double apart_m =
          grip.radius_m + radius_or(other, input.config.object.object_radius_m) + input.config.drop.room_m;
      const Eigen::Vector2d p_C = X_MC.to_local({other.x_m, other.y_m});
      if (p_C.norm() > zone_m || std::abs(p_C.y()) > apart_m) continue;
      at_m = std::min(at_m, p_C.x() - std::sqrt(apart_m * apart_m - p_C.y() * p_C.y()));
    }
    return std::max(at_m, -kInside * zone_m);
  }

  void stop(const TaskInput& input, Grip& grip, TaskOutput& output) {
    constexpr double kSlides_s = 0.5;  // the wave fades, and the object with it, within this time
    output.phase = "stop";
    stand(grip, output);
    if (state_.phase_s < kSlides_s) return;
    state_.p_MO = object_M(input, grip);
    grip.carrying = false;  // on purpose: no loss is reported
    enter(input, kOpen);
  }

  void open(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const DropConfig& config = input.config.drop;
    output.phase = "open";
    const auto shape = input.grip_sense.open_shape(grip.side, config.open_angle_rad);
    move_in_shape({"leave", 0.0}, 0.0, 1.0, shape, input.grip_sense.yaw_joint_count(), output);
    output.desired.shape_rate_rad_s = std::max(0.02, largest_opening(grip, shape) / config.open_s);
    if (state_.phase_s < config.open_s) return;
    enter(input, kBack);
  }

  static double largest_opening(const Grip& grip, const std::array<double, msg::kMaxJoints>& shape) {
    double largest_rad = 0.0;
    for (std::size_t k = 0; k < shape.size(); ++k)
      largest_rad = std::max(largest_rad, std::abs(grip.shape_rad[k] - shape[k]));
    return largest_rad;
  }

  void back(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const DropConfig& config = input.config.drop;
    output.phase = "back off";
    const auto shape = input.grip_sense.open_shape(grip.side, config.open_angle_rad);
    // The object must stay in the middle between the arms, or an arm pushes it: on a slope the body slides downhill
    // while it backs off. The arms bend towards the object, like a path that leads there.
    const PlanarPose X_MU{object_M(input, grip), input.X_MH.yaw_rad + input.grip_sense.mouth_rad(input.body)};
    const Steering steering(config.back_steering);
    steering.observe(input.tick.time_s(), X_MU.to_local(state_.p_MO).y(), input.sway_period_s, state_.back);
    move_in_shape({"leave", config.back_m_s}, steering.curvature(input.tick.dt_s(), state_.back), -1.0, shape,
                  input.grip_sense.yaw_joint_count(), output);
    keep_upright(input.config, grip, output);
    const double backed_m = (input.X_MH.p - state_.from.p).norm();
    const bool enough = backed_m >= config.back_m && !arms_reach_an_object(input, grip);
    if (enough || backed_m >= kFarther * config.back_m || state_.phase_s > config.back_timeout_s)
      enter(input, kStraighten);
  }

  /// True while the arms, which sweep outwards when the body straightens, would push an object of the map: it lies
  /// before the base and nearer to it than the end of the longer arm.
  [[nodiscard]] static bool arms_reach_an_object(const TaskInput& input, const Grip& grip) {
    constexpr double kRoom_m = 0.1;  // the map's error, and the base, which moves when the arms do
    const Eigen::Vector2d p_HU = input.grip_sense.held_object_H(input.body, 0.0);
    const PlanarPose X_MU{input.X_MH.to_parent(p_HU), input.X_MH.yaw_rad + input.grip_sense.mouth_rad(input.body)};
    const double arm_m = std::max((input.body.front().p - p_HU).norm(), (input.body.back().p - p_HU).norm());
    for (const msg::MapObject& other : input.map ? landmarks_of(*input.map) : std::span<const msg::MapObject>{}) {
      if (!is_another_object(other, grip)) continue;
      const Eigen::Vector2d p_U = X_MU.to_local({other.x_m, other.y_m});
      if (p_U.x() > 0.0 && p_U.norm() - radius_or(other, input.config.object.object_radius_m) < arm_m + kRoom_m)
        return true;
    }
    return false;
  }

  /// An object that is not the one in the U, or let go by it.
  [[nodiscard]] static bool is_another_object(const msg::MapObject& landmark, const Grip& grip) {
    return landmark.kind == msg::kBlobObject && !landmark.carried && landmark.handle != grip.handle;
  }

  void straighten(const TaskInput& input, Grip& grip, TaskOutput& output) {
    output.phase = "straighten";
    bend_head(0.0, input.config.drop.straighten_rate_rad_s, grip, output);
    if (!input.motion_done || state_.phase_s < 0.2) return;
    enter(input, kClear);
  }

  void clear(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const DropConfig& config = input.config.drop;
    output.phase = "back off straight";
    move_on(input, 0.0, -1.0, grip, output);
    if ((input.X_MH.p - state_.from.p).norm() < config.clear_m && state_.phase_s < config.back_timeout_s) return;
    output.emit(msg::kEventDroppingDone, grip.colour, grip.handle);
    output.succeed();
  }
};

}  // namespace

std::unique_ptr<Task> make_drop() { return std::make_unique<Drop>(); }

}  // namespace constrictor
