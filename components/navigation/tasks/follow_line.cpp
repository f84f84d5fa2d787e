// Follow line (Tables I, II): a PID on the line's lateral offset ahead, or sliding mode control of the heading, steers
// the undulation, with or without an object in the U.
#include <algorithm>
#include <cmath>

#include "navigation/motions.hpp"
#include "navigation/sliding_steering.hpp"
#include "navigation/steering.hpp"

namespace constrictor {
namespace {

struct FollowLineState {
  LineTrackerState line;
  SteeringState steering;
  SlidingSteeringState sliding;
  bool found = false;        ///< the event "line found" was sent
  double travelled_m = 0.0;  ///< largest distance from the start, for the progress
  PlanarPose start;          ///< the head at the start
  double curvature_1_m = 0.0;
  bool by_map = false;  ///< the last image did not show the line, and the map did
  template <class Archive>
  void serialize(Archive& archive) {
    archive(line, steering, sliding, found, travelled_m, start, curvature_1_m, by_map);
  }
};

class FollowLine : public StatefulTask<FollowLineState> {
 public:
  void start(const TaskInput& input, Grip&) override { state_.start = input.X_MH; }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const NavigationConfig& config = input.config;
    const std::uint8_t colour = input.parameters.line_colour;
    PidGains gains = config.follow_line.steering;
    if (grip.carrying) gains.limit = config.follow_line.carry_limit_1_m;
    if (input.line) {
      update_line_tracker(config.line, *input.line, colour, state_.line);
      if (state_.line.missed == 0) {
        observe(input, shift_m(input, grip));
      } else {
        state_.by_map = observe_map(input, grip);
      }
    }
    if (state_.line.visible && !state_.found) {
      state_.found = true;
      output.emit(msg::kEventLineFound, colour);
    }
    // While the line is out of view for a moment and the map does not have it, the last curvature continues.
    if (state_.line.missed == 0 || state_.by_map)
      state_.curvature_1_m = curvature(config.follow_line, gains, input.tick.dt_s());
    move_on(input, state_.curvature_1_m, 1.0, grip, output);
    output.phase = state_.line.visible ? "follow" : state_.found ? "coast" : "look";
    const double away_m = (input.X_MH.p - state_.start.p).norm();
    state_.travelled_m = std::max(state_.travelled_m, away_m);
    output.progress = 1.0 - 1.0 / (1.0 + state_.travelled_m);  // the length of the line is unknown

    if (state_.line.end_seen >= config.follow_line.end_images &&
        state_.line.end_distance_m <= config.follow_line.end_reached_m) {
      output.emit(msg::kEventEndOfLine, colour);
      output.succeed();
    } else if (state_.line.missed >= config.line.lost_after) {
      output.emit(msg::kEventLineLost, colour);
      output.abort("line lost");
    }
  }

 private:
  /// Both laws observe the line, so that either may take over at any time.
  void observe(const TaskInput& input, double shift_m) {
    const double time_s = input.tick.time_s(), period_s = input.sway_period_s;
    const LineTrackerState& line = state_.line;
    const double offset_m = line.offset_m + shift_m;
    Steering::observe(time_s, offset_m, period_s, state_.steering);
    SlidingSteering::observe(time_s, {input.config.line.lookahead_m, offset_m, line.heading_rad, line.curvature_1_m},
                             period_s, state_.sliding);
  }
  /// With an object, the line of the map stands for one that an image does not show: the head swings, and where it sees
  /// the line only at the end of a swing, it measures offsets on one side only, which hardly turn the robot.
  bool observe_map(const TaskInput& input, const Grip& grip) {
    if (!grip.carrying || !maps_wanted_line(input)) return false;
    const double offset_m = mapped_offset_m(input, input.config.line.lookahead_m);
    if (!std::isfinite(offset_m)) return false;
    Steering::observe(input.tick.time_s(), offset_m, input.sway_period_s, state_.steering);
    return true;
  }
  /// [m] to the left of the line, at which the head drives so that the U passes between obstacles.
  [[nodiscard]] double shift_m(const TaskInput& input, const Grip& grip) const {
    if (!grip.carrying) return 0.0;
    const PlanarPose X_HL{{input.config.line.lookahead_m, state_.line.offset_m}, state_.line.heading_rad};
    return carrying_shift_m(input, X_HL);
  }
  double curvature(const FollowLineConfig& config, const PidGains& gains, double dt_s) {
    if (config.law == kSteerBySlidingMode)
      return SlidingSteering(config.sliding, gains.limit).curvature(state_.sliding);
    return Steering(gains).curvature(dt_s, state_.steering);
  }
};

}  // namespace

std::unique_ptr<Task> make_follow_line() { return std::make_unique<FollowLine>(); }

}  // namespace constrictor
