// Track object (Tables V, VI): a PID on the object's bearing steers the undulation at constant speed until it is directly in front.
#include <algorithm>
#include <cmath>

#include "navigation/motions.hpp"
#include "navigation/steering.hpp"

namespace constrictor {
namespace {

struct TrackState {
  SteeringState steering;
  bool backing = false;
  Pose2 back_from;
  double first_distance_m = 0.0;
  double progress = 0.0;
  int missed = 0;             ///< images in a row in which it should have been seen and was not
  template <class Archive>
  void serialize(Archive& archive) {
    archive(steering, backing, back_from, first_distance_m, progress, missed);
  }
};

class TrackObject : public StatefulTask<TrackState> {
 public:
  std::string refusal(const TaskInput& input, const Grip& grip) const override {
    const std::uint8_t colour = input.parameters.object_colour;
    if (colour == msg::kColourUnknown) return "track_object needs an object colour";
    if (grip.carrying) return "track_object cannot run while carrying";
    if (!input.things.objects[colour].known) return "no object of this colour was seen yet";
    return "";
  }
  void start(const TaskInput& input, Grip&) override {
    state_.first_distance_m = (input.things.objects[input.parameters.object_colour].p_M() - input.X_MH.p).norm();
  }

  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const TrackConfig& config = input.config.track;
    const Gait& gait = input.config.travel;
    const std::uint8_t colour = input.parameters.object_colour;
    const Sighting& thing = input.things.objects[colour];
    const Eigen::Vector2d p_HO = input.X_MH.to_local(thing.p_M());
    const double bearing_rad = std::atan2(p_HO.y(), p_HO.x());
    const double range_m = p_HO.norm() - thing.radius_m;

    // Out of the field of view it is steered for by memory; inside, it must be seen.
    const bool in_view = std::abs(bearing_rad) < config.half_view_rad;
    if (input.image) state_.missed = thing.missed == 0 || !in_view ? 0 : state_.missed + 1;
    const double unseen_s = static_cast<double>(input.tick.index - thing.seen_tick) * input.tick.period_s();
    if (state_.missed >= input.config.object.lost_after || unseen_s > config.memory_s) {
      output.emit(msg::kEventObjectLost, colour);
      output.abort("object lost");
      stand(grip, output);
      return;
    }

    const Steering steering(config.steering);
    steering.observe(input.tick.time_s(), bearing_rad, gait_period_s(gait), state_.steering);
    const double mean_rad = Steering::mean_error(state_.steering);
    if (state_.first_distance_m > config.reach_m) {
      const double way = (state_.first_distance_m - range_m) / (state_.first_distance_m - config.reach_m);
      state_.progress = std::max(state_.progress, std::clamp(way, 0.0, 0.99));
    }
    output.progress = state_.progress;

    if (state_.backing) {
      back_off(input, grip, config, output);
      return;
    }
    const double curvature_1_m = steering.curvature(input.tick.dt_s(), state_.steering);
    undulate(gait, curvature_1_m, 1.0, grip, output);
    output.phase = in_view ? "track" : "turn to";
    if (range_m <= config.reach_m && std::abs(mean_rad) <= config.reach_bearing_rad && thing.missed == 0) {
      output.emit(msg::kEventObjectReached, colour);
      output.succeed();
    } else if (range_m <= config.too_near_m) {
      state_.backing = true;
      state_.back_from = input.X_MH;
    }
  }

 private:
  void back_off(const TaskInput& input, Grip& grip, const TrackConfig& config, TaskOutput& output) {
    undulate(input.config.travel, 0.0, -1.0, grip, output);
    output.phase = "back off";
    if ((input.X_MH.p - state_.back_from.p).norm() < config.back_off_m) return;
    state_.backing = false;
    state_.steering = {};
  }
};

}  // namespace

std::unique_ptr<Task> make_track_object() { return std::make_unique<TrackObject>(); }

}  // namespace constrictor
