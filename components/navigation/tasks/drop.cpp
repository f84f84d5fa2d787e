// Drop (Tables XI, XII): the robot drives over the drop zone of a colour until the zone has left the view, continues
// until the held object is over the zone's centre, stops, opens the U, backs off, straightens, and backs off farther.
// The body sweeps the ground when it turns later; what was dropped must be out of its reach.
#include <algorithm>
#include <array>
#include <cereal/types/array.hpp>
#include <cereal/types/deque.hpp>
#include <cmath>
#include <deque>

#include "navigation/motions.hpp"
#include "navigation/steering.hpp"

namespace constrictor {
namespace {

enum Phase : int { kApproach, kOver, kStop, kOpen, kBack, kStraighten, kClear };

/// The place of the held object in the map. The gait shakes the object, so its place is averaged over whole periods of
/// the gait: the mean over the last period lies half a period back, and the way from the mean over the period before
/// leads from there to the present.
class ShakenPlace {
 public:
  void observe(double time_s, const Eigen::Vector2d& p_M, double period_s) {
    samples_.push_back({time_s, p_M.x(), p_M.y()});
    while (samples_.front()[0] < time_s - 2.0 * period_s) samples_.pop_front();
  }
  /// [m] present place in M.
  [[nodiscard]] Eigen::Vector2d place(double period_s) const {
    const Means means = means_of(period_s);
    return means.two_periods ? Eigen::Vector2d(means.last + 0.5 * (means.last - means.before)) : means.last;
  }
  template <class Archive>
  void serialize(Archive& archive) {
    archive(samples_);
  }

 private:
  struct Means {
    Eigen::Vector2d last, before;  ///< [m] over the last period, and over the period before it
    bool two_periods;
  };
  [[nodiscard]] Means means_of(double period_s) const {
    std::array<Eigen::Vector2d, 2> sum{Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};
    std::array<int, 2> count{0, 0};
    for (const auto& [time_s, x_m, y_m] : samples_) {
      const std::size_t older = time_s < samples_.back()[0] - period_s ? 1 : 0;
      sum[older] += Eigen::Vector2d(x_m, y_m);
      ++count[older];
    }
    const bool two_periods = samples_.back()[0] - samples_.front()[0] > 1.9 * period_s;
    return {sum[0] / count[0], sum[1] / std::max(1, count[1]), two_periods};
  }
  std::deque<std::array<double, 3>> samples_;  ///< (time [s], x, y [m] in M), oldest first
};

struct DropState : PhaseState {
  Eigen::Vector2d p_MZ{0.0, 0.0};
  double course_rad = 0.0;  ///< heading in M of the straight course over the zone
  bool course_fixed = false;
  SteeringState steering;
  ShakenPlace object;
  PlanarPose from;  ///< the head when the phase began
  template <class Archive>
  void serialize(Archive& archive) {
    archive(phase, phase_s, p_MZ.x(), p_MZ.y(), course_rad, course_fixed, steering, object, from);
  }
};

class Drop : public StatefulTask<DropState> {
 public:
  /// The zone has a place in the map, and the object is let go by touch.
  [[nodiscard]] bool steers_by_sight() const override { return false; }
  std::string refusal(const TaskInput& input, const Grip& grip) const override {
    if (!grip.carrying) return "drop cannot run: the robot carries no object";
    if (!input.sightings.zones[input.parameters.drop_zone_colour].known)
      return "no drop zone of this colour was seen yet";
    return "";
  }
  void start(const TaskInput& input, Grip&) override {
    state_.p_MZ = input.sightings.zones[input.parameters.drop_zone_colour].p_M();
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

  void drive(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const DropConfig& config = input.config.drop;
    const Sighting& zone = input.sightings.zones[input.parameters.drop_zone_colour];
    if (zone.missed == 0) {
      state_.p_MZ = zone.p_M();
    } else if (state_.phase == kApproach && !zone.visible) {
      enter(input, kOver);
    }
    output.phase = state_.phase == kApproach ? "approach" : "over the zone";
    const double period_s = gait_period_s(present_gait(input.config, grip));
    const double now_s = input.tick.time_s();
    const Eigen::Vector2d p_HO = input.grip_sense.held_object_H(input.body, grip.radius_m);
    state_.object.observe(now_s, input.X_MH.to_parent(p_HO), period_s);
    const Eigen::Vector2d p_MO = state_.object.place(period_s);
    // The object follows the head and cuts corners. The course is therefore the straight line from the object through
    // the zone's centre, and the head drives parallel to it, at the object's lateral distance from the head.
    const Eigen::Vector2d d = state_.p_MZ - p_MO;
    if (d.norm() > config.fix_course_m || !state_.course_fixed) {
      state_.course_rad = std::atan2(d.y(), d.x());
      state_.course_fixed = true;
    }
    const PlanarPose X_MC{state_.p_MZ, state_.course_rad};  // the course through the zone's centre
    const Eigen::Vector2d p_line = X_MC.to_parent({0.0, -input.grip_sense.held_aside_m(grip, input.feels)});
    const Steering steering(config.steering);
    const double error_m = path_error_m(input.X_MH, p_line, state_.course_rad, config.lookahead_m);
    steering.observe(now_s, error_m, period_s, state_.steering);
    const Gait gait = gentle(d.norm() > config.slow_m ? input.config.carry : config.gait, input.config, grip);
    undulate(gait, steering.curvature(input.tick.dt_s(), state_.steering), 1.0, grip, output);
    const double past_m = X_MC.to_local(p_MO).x();
    if (state_.phase_s > config.approach_timeout_s)
      return output.abort("the zone was not reached in time");  // the robot still holds the object
    if (past_m >= -config.brake_m) {
      enter(input, kStop);
      stand(grip, output);
    }
  }

  void stop(const TaskInput& input, Grip& grip, TaskOutput& output) {
    constexpr double kSlides_s = 0.5;  // the wave fades, and the object with it, within this time
    output.phase = "stop";
    stand(grip, output);
    if (state_.phase_s < kSlides_s) return;
    grip.carrying = false;  // on purpose: no loss is reported
    enter(input, kOpen);
  }

  void open(const TaskInput& input, Grip& grip, TaskOutput& output) {
    const DropConfig& config = input.config.drop;
    output.phase = "open";
    Gait still = input.config.travel;
    still.amplitude_rad = 0.0;
    still.frequency_hz = 0.0;
    const auto shape = input.grip_sense.open_shape(grip.side, config.open_angle_rad);
    undulate_on(still, 0.0, 1.0, shape, input.grip_sense.yaw_joint_count(), output);
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
    undulate_on(gentle(config.back, input.config, grip), 0.0, -1.0, shape, input.grip_sense.yaw_joint_count(), output);
    if ((input.X_MH.p - state_.from.p).norm() >= config.back_m || state_.phase_s > config.back_timeout_s)
      enter(input, kStraighten);
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
    undulate(input.config.travel, 0.0, -1.0, grip, output);
    if ((input.X_MH.p - state_.from.p).norm() < config.clear_m && state_.phase_s < config.back_timeout_s) return;
    output.emit(msg::kEventDroppingDone, grip.colour, grip.handle);
    output.succeed();
  }
};

}  // namespace

std::unique_ptr<Task> make_drop() { return std::make_unique<Drop>(); }

}  // namespace constrictor
