// Pregrasp (Tables VII, VIII): the snake bends away until the object leaves the view and passes beside it in forward
// steps. After each step it bends the joints behind the object, so that the part of the body in front of them swings
// against the object and touches it. The task ends when the object lies beside the body where the body can be wrapped
// round it. A robot without contact sensors makes no such movement.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "navigation/motions.hpp"
#include "navigation/object_handles.hpp"
#include "navigation/passing_room.hpp"
#include "navigation/steering.hpp"

namespace constrictor {
namespace {

constexpr double kStep_m = 0.12;       // of the head, after a touch movement that did not touch the object
constexpr std::size_t kSwinging = 12;  // modules that the touch movement can move

struct PregraspState : PhaseState {
  double side = 1.0;        ///< +1: the object stays on the left
  double course_rad = 0.0;  ///< heading of the passing line in M
  Eigen::Vector2d p_MO{0.0, 0.0};
  double radius_m = 0.085;
  double height_m = 0.0;  ///< of the object; 0: unknown
  double past_m = 0.0;    ///< distance by which the head must pass the object's centre
  int attempts = 0;       ///< touch movements so far
  int misses = 0;         ///< attempts without a touch
  bool felt = false;      ///< the present attempt touched the object
  bool deep = false;      ///< the object lies between deep_min_m and deep_max_m along the body
  PlanarPose rest;        ///< the head before the touch movement
  int bend_joint = 0;     ///< first of the yaw joints that bend in the touch movement
  SteeringState steering;
  double unseen_s = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(phase, phase_s, side, course_rad, p_MO.x(), p_MO.y(), radius_m, height_m, past_m, attempts, misses, felt,
            deep, rest, bend_joint, steering, unseen_s);
  }
};

class Pregrasp : public StatefulTask<PregraspState> {
  enum Phase : int { kBendAway, kAdvance, kSettle, kTouch, kUnbend };

 public:
  std::string refusal(const TaskInput& input, const Grip& grip) const override {
    if (!input.grip_sense.refusal().empty()) return input.grip_sense.refusal();
    if (grip.carrying) return "pregrasp cannot run while the robot carries an object";
    const Sighting& object = input.sightings.objects[input.parameters.object_colour];
    const double unseen_s = static_cast<double>(input.tick.index - object.seen_tick) * input.tick.period_s();
    if (!object.known || unseen_s > input.config.pregrasp.seen_within_s) return "the object is not in view";
    if (object.radius_m > input.grip_sense.largest_seen_radius_m()) return too_large(object, input.grip_sense);
    return handle_refusal(input);
  }

  void start(const TaskInput& input, Grip& grip) override {
    grip.pregrasped = false;
    const Sighting& object = input.sightings.objects[input.parameters.object_colour];
    state_.p_MO = object.p_M();
    state_.radius_m = object.radius_m;
    state_.height_m = object.height_m;
    state_.past_m = input.config.pregrasp.past_m;
    state_.side = choose_side(input);
    state_.course_rad = tangent_course(input, state_.side);
  }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const Sighting& object = input.sightings.objects[input.parameters.object_colour];
    state_.phase_s += input.tick.dt_s();
    if (state_.phase == kBendAway && object.missed == 0 && input.new_percepts) {
      state_.p_MO = object.p_M();
      state_.radius_m = object.radius_m;
      state_.height_m = object.height_m;
    }
    output.direction = state_.side > 0.0 ? msg::kDirectionLeft : msg::kDirectionRight;
    output.progress = std::min(0.95, 0.2 * state_.phase + 0.1 * state_.attempts);
    run_phase<Pregrasp, 5>(
        *this, {&Pregrasp::bend_away, &Pregrasp::advance, &Pregrasp::settle, &Pregrasp::touch, &Pregrasp::unbend},
        state_.phase, input, grip, output);
  }

 private:
  void enter(int phase) {
    state_.enter(phase);
    state_.steering = {};
  }

  /// [m] between the object's centre and the middle line of the passing body.
  [[nodiscard]] double passing_m(const TaskInput& input) const {
    const double wanted_m = input.parameters.clearance_m;
    const double clearance_m = wanted_m > 0.0 ? wanted_m : input.config.pregrasp.clearance_m;
    return state_.radius_m + input.robot.module_radius_m + clearance_m;
  }

  /// [rad] heading in M of the straight line from the head that passes the object at the distance passing_m.
  [[nodiscard]] double tangent_course(const TaskInput& input, double side) const {
    const Eigen::Vector2d d = state_.p_MO - input.X_MH.p;
    const double aside = std::min(0.9, passing_m(input) / std::max(0.01, d.norm()));
    return std::atan2(d.y(), d.x()) - side * std::asin(aside);
  }

  /// The side of the body on which the object is passed, +1 left, -1 right: the side that the goal names. Otherwise the
  /// side on which other objects and obstacles leave more room for passing and wrapping; the nearer side if both
  /// leave enough.
  [[nodiscard]] double choose_side(const TaskInput& input) const {
    if (input.parameters.direction == msg::kDirectionLeft) return 1.0;
    if (input.parameters.direction == msg::kDirectionRight) return -1.0;
    double room_m[2];
    for (const int option : {0, 1}) {
      const double side = option == 0 ? 1.0 : -1.0;
      const PlanarPose X_MP{state_.p_MO, tangent_course(input, side)};
      room_m[option] = passing_room_m(input, X_MP, side, passing_m(input), state_.radius_m);
    }
    const double wanted_m = input.config.pregrasp.other_clearance_m;
    if (std::min(room_m[0], wanted_m) != std::min(room_m[1], wanted_m)) return room_m[0] > room_m[1] ? 1.0 : -1.0;
    return input.X_MH.to_local(state_.p_MO).y() >= 0.0 ? 1.0 : -1.0;
  }

  /// Why an object that looks too large is not grasped.
  static std::string too_large(const Sighting& object, const GripSense& sense) {
    constexpr double kLow = 0.9;  // height by radius: one that stands, and is as low, would be a plate
    const bool lies = object.height_m > 0.0 && object.height_m < kLow * object.radius_m;
    return fmt::format("the object {} the U: found a radius of {:.3f} m, accepted at most {:.3f} m",
                       lies ? "lies on its side, or is too large for" : "is too large for", object.radius_m,
                       sense.largest_radius_m());
  }

  /// Steers along the passing line.
  void pass(const TaskInput& input, const Pace& pace, Grip& grip, TaskOutput& output) {
    const PregraspConfig& config = input.config.pregrasp;
    const PlanarPose X_MP{state_.p_MO, state_.course_rad};
    const Eigen::Vector2d p_line = X_MP.to_parent({0.0, -state_.side * passing_m(input)});
    const Steering steering(config.steering);
    const double error_m = path_error_m(input.X_MH, p_line, state_.course_rad, config.lookahead_m);
    steering.observe(input.tick.time_s(), error_m, input.sway_period_s, state_.steering);
    move_along(pace, steering.curvature(input.tick.dt_s(), state_.steering), 1.0, grip, output);
  }

  /// [m] distance of the head beyond the object's centre along the passing line; negative before it.
  [[nodiscard]] double past_m(const TaskInput& input) const {
    return PlanarPose{state_.p_MO, state_.course_rad}.to_local(input.X_MH.p).x();
  }

  void bend_away(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const Sighting& object = input.sightings.objects[input.parameters.object_colour];
    output.phase = "bend away";
    pass(input, {"travel", input.config.travel_m_s}, grip, output);
    const bool beside =
        std::abs(input.X_MH.to_local(state_.p_MO).y()) > 0.6 * std::abs(input.X_MH.to_local(state_.p_MO).x());
    if (!object.visible || beside || past_m(input) > -0.25) enter(kAdvance);
    // The object should be in view and is not: it has been taken away.
    const double bearing_rad =
        std::abs(std::atan2(input.X_MH.to_local(state_.p_MO).y(), input.X_MH.to_local(state_.p_MO).x()));
    if (!object.visible && bearing_rad < 0.5 && past_m(input) < -0.35)
      lose(input, grip, output, "the object vanished while in view");
  }

  void advance(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const PregraspConfig& config = input.config.pregrasp;
    output.phase = "advance";
    pass(input, {"creep", input.config.creep_m_s}, grip, output);
    if (past_m(input) >= state_.past_m - config.brake_m) enter(kSettle);
    if (state_.phase_s > 15.0) enter(kSettle);
  }

  /// The first yaw joint that lies at least kLever_m behind a place of the straight body, `behind_m` behind the head's
  /// centre. When it bends, the place moves sideways.
  static int first_joint_behind(const TaskInput& input, double behind_m) {
    constexpr double kLever_m = 0.05;
    constexpr std::size_t kLast = 4;  // the joints behind are needed for the base of the U
    const std::vector<std::size_t> yaw_joints = input.robot.yaw_joints();
    std::size_t k = 0;
    while (k < kLast && (static_cast<double>(yaw_joints[k]) + 0.5) * input.robot.module_length_m < behind_m + kLever_m)
      ++k;
    return static_cast<int>(k);
  }

  void settle(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const PregraspConfig& config = input.config.pregrasp;
    output.phase = "settle";
    bend_head(0.0, config.touch_rate_rad_s, grip, output);
    if (state_.phase_s < config.settle_s || !input.motion_done) return;
    state_.rest = input.X_MH;
    if (!input.feels) return judge_unfelt(input, grip, output);
    state_.bend_joint = first_joint_behind(input, -state_.rest.to_local(state_.p_MO).x());
    state_.felt = false;
    state_.deep = false;
    enter(kTouch);
  }

  void touch(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const PregraspConfig& config = input.config.pregrasp;
    output.phase = "touch";
    // An object that was not touched is farther away than it looked: each attempt reaches farther.
    const double limit_rad = config.touch_limit_rad + config.touch_further_rad * state_.misses;
    bend_joints(static_cast<std::size_t>(state_.bend_joint), state_.side * limit_rad, config.touch_rate_rad_s, grip,
                output);
    const Touch* best = nullptr;
    for (const Touch& t : input.touches) {
      const PlanarPose& module = input.body[t.module];
      const bool inner_side = state_.side * t.normal_H.dot(module.left()) < 0.3;
      if (t.module < kSwinging && inner_side && t.force_n >= config.touch_force_n && is_object(input, t) &&
          (!best || t.force_n > best->force_n))
        best = &t;
    }
    if (best) {
      state_.felt = true;
      state_.p_MO = input.X_MH.to_parent(best->p_H - state_.radius_m * best->normal_H);
      const double along_m = state_.rest.to_local(state_.p_MO).x();
      state_.deep = along_m >= config.deep_min_m && along_m <= config.deep_max_m;
      enter(kUnbend);
    } else if (input.motion_done && state_.phase_s > 0.2) {
      enter(kUnbend);
    }
  }

  /// Whether a touch is one of the object: the map has this object there, or nothing, and the object cannot be far.
  [[nodiscard]] bool is_object(const TaskInput& input, const Touch& touch) const {
    constexpr double kMoved_m = 0.25;  // the body may have pushed the object this far from where it was seen
    if (touch.handle != 0) return touch.handle == object_handle(input);
    const Eigen::Vector2d p_MO = input.X_MH.to_parent(touch.p_H - state_.radius_m * touch.normal_H);
    return (p_MO - state_.p_MO).norm() < kMoved_m;
  }

  void unbend(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const PregraspConfig& config = input.config.pregrasp;
    output.phase = "unbend";
    bend_head(0.0, config.touch_rate_rad_s, grip, output);
    if (!input.motion_done || state_.phase_s < 0.2) return;
    ++state_.attempts;
    if (state_.deep) return succeed(input, grip, output);
    if (state_.attempts >= config.attempts) {
      lose(input, grip, output, "the object was not touched");
      return;
    }
    // If the touch was too near to the head, the head advances to its target beyond the place that was touched now. If
    // there was no touch, the next touch movement reaches farther aside, and the target moves on by kStep_m, unless the
    // object must already lie beside the body.
    if (!state_.felt) {
      ++state_.misses;
      if (past_m(input) < -config.deep_min_m - kStep_m)
        state_.past_m = std::max(state_.past_m, past_m(input)) + kStep_m;
    }
    enter(kAdvance);
  }

  /// A robot without contact sensors relies on the place at which it has seen the object.
  void judge_unfelt(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const PregraspConfig& config = input.config.pregrasp;
    const double along_m = state_.rest.to_local(state_.p_MO).x();
    if (along_m >= config.deep_min_m && along_m <= config.deep_max_m) return succeed(input, grip, output);
    if (along_m < config.deep_min_m || ++state_.attempts >= config.attempts)
      return lose(input, grip, output, "the object does not lie beside the body");
    state_.past_m = std::max(state_.past_m, past_m(input)) + kStep_m;
    enter(kAdvance);
  }

  void succeed(const TaskInput& input, Grip& grip, TaskOutput& output) {
    grip.pregrasped = true;
    grip.side = state_.side;
    grip.colour = input.parameters.object_colour;
    grip.handle = object_handle(input);
    grip.radius_m = state_.radius_m;
    grip.height_m = state_.height_m;
    grip.p_MO = state_.p_MO;
    output.emit(msg::kEventObjectPregrasped, grip.colour, grip.handle);
    output.succeed();
  }

  /// The handle that the goal names, otherwise the handle of the object seen here.
  static std::uint16_t object_handle(const TaskInput& input) {
    const std::uint16_t named = input.parameters.object_handle;
    return named != 0 ? named : seen_handle(input, input.parameters.object_colour);
  }

  void lose(const TaskInput& input, Grip& grip, TaskOutput& output, const char* why) {
    grip.pregrasped = false;
    stand(grip, output);
    output.emit(msg::kEventObjectPregraspLost, input.parameters.object_colour, object_handle(input));
    output.abort(why);
  }
};

}  // namespace

std::unique_ptr<Task> make_pregrasp() { return std::make_unique<Pregrasp>(); }

}  // namespace constrictor
