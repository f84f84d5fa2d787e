// Track object (Tables V, VI): a PID on the object's bearing steers the undulation at constant speed until the object
// is directly in front of a straight body. If the room does not suffice to turn towards the object and to straighten
// the body, the body first moves away as far as the turn needs, and then turns.
#include <algorithm>
#include <cmath>

#include "navigation/motions.hpp"
#include "navigation/object_handles.hpp"
#include "navigation/steering.hpp"
#include "navigation/turn_geometry.hpp"
#include "robot/planar.hpp"

namespace constrictor {
namespace {

struct TrackState {
  SteeringState steering;
  bool leaving = false;
  double leaving_s = 0.0;
  int leaves = 0;  ///< how often the body moved away
  bool turning = false;
  double first_distance_m = 0.0;
  double progress = 0.0;
  int missed = 0;  ///< consecutive images that should have shown the object and did not
  template <class Archive>
  void serialize(Archive& archive) {
    archive(steering, leaving, leaving_s, leaves, turning, first_distance_m, progress, missed);
  }
};

class TrackObject : public StatefulTask<TrackState> {
 public:
  std::string refusal(const TaskInput& input, const Grip& grip) const override {
    if (grip.carrying) return "track_object cannot run while the robot carries an object";
    if (!input.sightings.objects[input.parameters.object_colour].known) return "the map has no object of this colour";
    if (!is_named(input)) {
      return "object_handle: found " + std::to_string(input.parameters.object_handle) +
             ", accepted 0 or the handle of the object in view";
    }
    return "";
  }
  void start(const TaskInput& input, Grip&) override {
    state_.first_distance_m = (input.sightings.objects[input.parameters.object_colour].p_M() - input.X_MH.p).norm();
  }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const TrackConfig& config = input.config.track;
    const std::uint8_t colour = input.parameters.object_colour;
    const Sighting& object = input.sightings.objects[colour];
    const Eigen::Vector2d p_HO = input.X_MH.to_local(object.p_M());
    const double bearing_rad = std::atan2(p_HO.y(), p_HO.x());
    const double range_m = p_HO.norm() - object.radius_m;

    // Within the field of view the object must be seen; outside, its remembered place is enough.
    const bool in_view = std::abs(bearing_rad) < config.half_view_rad;
    if (input.new_percepts) state_.missed = object.missed == 0 || !in_view ? 0 : state_.missed + 1;
    const double unseen_s = static_cast<double>(input.tick.index - object.seen_tick) * input.tick.period_s();
    if (state_.missed >= input.config.object.lost_after || unseen_s > config.memory_s) {
      output.emit(msg::kEventObjectLost, colour, input.parameters.object_handle);
      output.abort("object lost");
      stand(grip, output);
      return;
    }

    const Steering steering(config.steering);
    steering.observe(input.tick.time_s(), bearing_rad, input.sway_period_s, state_.steering);
    const double mean_rad = Steering::mean_error(state_.steering);
    if (state_.first_distance_m > config.reach_m) {
      const double share = (state_.first_distance_m - range_m) / (state_.first_distance_m - config.reach_m);
      state_.progress = std::max(state_.progress, std::clamp(share, 0.0, 0.99));
    }
    output.progress = state_.progress;

    const Eigen::Vector2d d = object.p_M() - input.X_MH.p;
    const double turn_rad = wrap_angle(std::atan2(d.y(), d.x()) - body_course_rad(input));
    if (state_.leaving) {
      leave(input, grip, object, turn_rad, output);
      return;
    }
    double curvature_1_m = steering.curvature(input.tick.dt_s(), state_.steering);
    const bool was_turning = state_.turning;
    state_.turning = std::abs(turn_rad) > (was_turning ? 0.3 : config.turn_rad);
    const bool cramped = state_.turning && !was_turning && missing_room_m(input, object) > 0.0;
    if (state_.turning) curvature_1_m = std::copysign(config.turn_curvature_1_m, turn_rad);
    move_on(input, curvature_1_m, 1.0, grip, output);
    output.phase = in_view && !state_.turning ? "track" : "turn to";
    const bool straight = std::abs(turn_rad) <= config.straight_rad;
    const bool reached =
        range_m <= config.reach_m && std::abs(mean_rad) <= config.reach_bearing_rad && object.missed == 0;
    if (reached && straight && range_m > config.too_near_m) {
      output.emit(msg::kEventObjectReached, colour, seen_handle(input, colour));
      output.succeed();
    } else if (range_m <= config.too_near_m || cramped || (range_m <= config.reach_m && state_.turning)) {
      state_.leaving = true;
      state_.leaving_s = 0.0;
      ++state_.leaves;
    }
  }

 private:
  /// [m] By how much the way to the object is too short for the body to turn towards the object and to straighten.
  /// Negative if there is room to spare. The whole body bends into an arc of the turn's curvature. Its centre moves
  /// along this arc, and when the body straightens, the head is half a length ahead of the centre.
  static double missing_room_m(const TaskInput& input, const Sighting& object) {
    const TrackConfig& config = input.config.track;
    Eigen::Vector2d centre_H(0.0, 0.0);
    for (const PlanarPose& module : input.body) centre_H += module.p / static_cast<double>(input.body.size());
    const PlanarPose X_MC{input.X_MH.to_parent(centre_H), body_course_rad(input)};
    const double half_length_m = 0.5 * input.robot.module_length_m * static_cast<double>(input.robot.module_count);
    const TurnTowards turn = turn_towards(X_MC.to_local(object.p_M()), config.turn_radius_m);
    return half_length_m + config.too_near_m + object.radius_m - turn.straight_m;
  }

  /// Moves away until the turn towards the object has the room that it needs. If this was not enough the last time, the
  /// body moves farther, because it does not follow the computed circle exactly.
  void leave(const TaskInput& input, Grip& grip, const Sighting& object, double turn_rad, TaskOutput& output) {
    constexpr double kFarther_m = 0.35;
    constexpr int kMostFarther = 3;
    const double margin_m = kFarther_m * std::min(state_.leaves, kMostFarther);
    state_.leaving_s += input.tick.dt_s();
    const bool backwards = std::cos(turn_rad) > 0.0;
    move_on(input, 0.0, backwards ? -1.0 : 1.0, grip, output);
    output.phase = backwards ? "back off" : "leave";
    const bool away = missing_room_m(input, object) + margin_m <= 0.0 &&
                      nearest_module_m(input, object.p_M()) >= input.config.search.near_m;
    if (!away && state_.leaving_s < input.config.track.leave_timeout_s) return;
    state_.leaving = false;
    state_.turning = true;
    state_.steering = {};
  }
};

}  // namespace

std::unique_ptr<Task> make_track_object() { return std::make_unique<TrackObject>(); }

}  // namespace constrictor
