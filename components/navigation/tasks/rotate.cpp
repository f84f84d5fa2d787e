// Rotate (Tables XIII, XIV): the robot turns on the spot until the optional timeout, until another task starts, or
// until it is cancelled.
#include <algorithm>
#include <cmath>

#include "navigation/motions.hpp"

namespace constrictor {
namespace {

/// The task needs no more than the time of its goal.
struct RotateState {
  template <class Archive>
  void serialize(Archive&) {}
};

class Rotate : public StatefulTask<RotateState> {
 public:
  [[nodiscard]] bool keeps_time() const override { return true; }
  void start(const TaskInput&, Grip&) override {}
  void step(const TaskInput& input, Grip& grip, TaskOutput& output) override {
    const RotateConfig& config = input.config.rotate;
    const double sign = input.parameters.direction == msg::kDirectionLeft ? 1.0 : -1.0;
    const double curvature_1_m = sign * (grip.carrying ? config.carry_curvature_1_m : config.curvature_1_m);
    move_carefully(input, curvature_1_m, 1.0, grip, output);
    output.phase = "rotate";
    const double timeout_s = time_limit_s(input.parameters);
    if (!std::isfinite(timeout_s)) return;
    output.progress = std::min(1.0, input.run_s / timeout_s);
    if (input.run_s < timeout_s) return;
    output.emit(msg::kEventTimeout);
    output.succeed();
  }
};

}  // namespace

std::unique_ptr<Task> make_rotate() { return std::make_unique<Rotate>(); }

}  // namespace constrictor
