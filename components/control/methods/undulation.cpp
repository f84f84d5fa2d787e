// "undulation": lateral undulation, straight or on a posture (an object is carried between the arms of a U), forwards
// or backwards, steered by the curvature of the path. It is never done.
#include "control/wave_motion.hpp"

namespace constrictor {
namespace {

class Undulation : public ControlMethod {
 public:
  std::string_view name() const override { return "undulation"; }
  void start(const MethodInput& input, BodyState& body) const override { keep_residual(input, body); }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    const LinkArray shape_rad = desired_shape(input.desired, input.chain);
    advance_wave(input, 1.0, body);
    const double left_rad = advance_shape(input, shape_rad, desired_shape_rate(input), body);
    ride(input, shape_rad, body, setpoints);
    return {false, left_rad > 0.0 ? 0.0 : 1.0};
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_undulation() { return std::make_unique<Undulation>(); }

}  // namespace constrictor
