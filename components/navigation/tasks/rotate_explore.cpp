// Rotate (Tables XIII, XIV): turns on the spot, until the optional timeout. Explore (Table XV): the head looks left and right
// between small steps of the body. Both run until something else is started or they are cancelled.
#include <cmath>

#include "navigation/motions.hpp"

namespace constrictor {
namespace {

struct RotateState {
  double run_s = 0.0;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(run_s);
  }
};

class Rotate : public StatefulTask<RotateState> {
 public:
  std::string refusal(const TaskInput& input, const Grip&) const override {
    const std::uint8_t direction = input.parameters.direction;
    if (direction != msg::kDirectionLeft && direction != msg::kDirectionRight) return "rotate needs the direction left or right";
    return "";
  }
  void start(const TaskInput&, Grip&) override {}
  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const RotateConfig& config = input.config.rotate;
    const double sign = input.parameters.direction == msg::kDirectionLeft ? 1.0 : -1.0;
    const double curvature_1_m = sign * (grip.carrying ? config.carry_curvature_1_m : config.curvature_1_m);
    undulate(present_gait(input.config, grip), curvature_1_m, 1.0, grip, output);
    output.phase = "rotate";
    state_.run_s += input.tick.dt_s();
    const double timeout_s = input.parameters.timeout_s;
    if (!std::isfinite(timeout_s) || timeout_s <= 0.0) return;
    output.progress = std::min(1.0, state_.run_s / timeout_s);
    if (state_.run_s < timeout_s) return;
    output.emit(msg::kEventTimeout);
    output.succeed();
  }
};

enum Phase : int { kLookLeft, kLookRight, kStep };

struct ExploreState {
  int phase = kStep;
  double phase_s = 0.0;
  Pose2 from;
  template <class Archive>
  void serialize(Archive& archive) {
    archive(phase, phase_s, from);
  }
};

class Explore : public StatefulTask<ExploreState> {
 public:
  std::string refusal(const TaskInput& input, const Grip&) const override {
    return input.parameters.direction == msg::kDirectionNone ? "explore needs a direction" : "";
  }
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
  static void small_step(const TaskInput& input, const Grip& grip, TaskOutput& output) {
    constexpr double kSideways_1_m = 0.8;
    const std::uint8_t direction = input.parameters.direction;
    const double way = direction == msg::kDirectionBackwards ? -1.0 : 1.0;
    const double bend = direction == msg::kDirectionLeft ? 1.0 : direction == msg::kDirectionRight ? -1.0 : 0.0;
    undulate(present_gait(input.config, grip), bend * kSideways_1_m, way, grip, output);
  }
};

}  // namespace

std::unique_ptr<Task> make_rotate() { return std::make_unique<Rotate>(); }
std::unique_ptr<Task> make_explore() { return std::make_unique<Explore>(); }

std::unique_ptr<Task> make_task(std::uint8_t kind) {
  switch (kind) {
    case msg::kTaskFollowLine: return make_follow_line();
    case msg::kTaskSearchObject: return make_search_object();
    case msg::kTaskTrackObject: return make_track_object();
    case msg::kTaskPregrasp: return make_pregrasp();
    case msg::kTaskGrasp: return make_grasp();
    case msg::kTaskDrop: return make_drop();
    case msg::kTaskRotate: return make_rotate();
    case msg::kTaskExplore: return make_explore();
    case msg::kTaskFollowPath: return make_follow_path();
    default: return nullptr;
  }
}

}  // namespace constrictor
