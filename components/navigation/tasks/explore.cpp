// Explore (Table XV): the head looks left and right between small steps of the body, until another task starts or until
// it is cancelled.
#include "navigation/motions.hpp"

namespace constrictor {
namespace {

struct ExploreState {
  int phase = 0;
  double phase_s = 0.0;
  PlanarPose from;  ///< the head when the phase began
  SteeringState steering;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(phase, phase_s, from, steering);
  }
};

class Explore : public StatefulTask<ExploreState> {
  enum Phase : int { kLookLeft, kLookRight, kStep };

 public:
  void start(const TaskInput& input, Grip&) override { enter(input, kStep); }
  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const ExploreConfig& config = input.config.explore;
    const double turn_rad = grip.carrying ? config.carry_turn_rad : config.head_turn_rad;
    state_.phase_s += input.tick.dt_s();
    const bool done = input.motion_done && state_.phase_s > 0.1;
    if (state_.phase == kStep) {
      output.phase = "step";
      small_step(input, grip, output);
      if ((input.X_MH.p - state_.from.p).norm() >= config.step_m || state_.phase_s > 5.0) enter(input, kLookLeft);
      return;
    }
    const double sign = state_.phase == kLookLeft ? 1.0 : -1.0;
    output.phase = state_.phase == kLookLeft ? "look left" : "look right";
    bend_head(sign * turn_rad / 3.0, config.head_rate_rad_s, grip, output);
    if (done) enter(input, state_.phase == kLookLeft ? kLookRight : kStep);
  }

 private:
  void enter(const TaskInput& input, int phase) {
    state_.phase = phase;
    state_.phase_s = 0.0;
    state_.from = input.X_MH;
  }
  void small_step(const TaskInput& input, const Grip& grip, TaskOutput& output) {
    constexpr double kSideways_1_m = 0.8;
    const std::uint8_t direction = input.parameters.direction;
    const double sense = direction == msg::kDirectionBackwards ? -1.0 : 1.0;
    const double bend = direction == msg::kDirectionLeft ? 1.0 : direction == msg::kDirectionRight ? -1.0 : 0.0;
    // With an object the camera hardly sees the line beside the way.
    const bool to_line = grip.carrying && direction == msg::kDirectionForwards && maps_wanted_line(input);
    const double curvature_1_m = to_line ? back_to_line_1_m(input, state_.steering) : bend * kSideways_1_m;
    move_carefully(input, curvature_1_m, sense, grip, output);
  }
};

}  // namespace

std::unique_ptr<Task> make_explore() { return std::make_unique<Explore>(); }

}  // namespace constrictor
