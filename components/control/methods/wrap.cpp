// "wrap": the desired posture (the base of a U) slides along the body from in front of the head to its place, while the
// body undulates along itself. Each module follows the module in front of it round the object, and the head ends up
// facing backwards. The method is done when the posture is in its place. Source: follow-the-leader motion; the
// values of speed and gait were found by measurements of grasps.
#include <algorithm>
#include <cmath>

#include "control/wave_motion.hpp"

namespace constrictor {
namespace {

/// [m] distance by which the posture must be moved towards the head so that it lies completely in front of it.
double start_distance_m(const MethodInput& input, const LinkArray& shape_rad) {
  double last = 0.0;
  for (std::size_t k = 0; k < input.chain.joint_count(); ++k) {
    if (std::abs(shape_rad[k]) > 0.0) last = static_cast<double>(k) + 1.0;
  }
  return last * input.chain.link_length_m();
}

class Wrap : public ControlMethod {
 public:
  std::string_view name() const override { return "wrap"; }
  bool accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const override {
    return ControlMethod::accepts(desired, chain) && desired.shape_count > 0 && desired.slide_m_s > 0.0;
  }
  void start(const MethodInput& input, BodyState& body) const override {
    keep_residual(input, body);
    body.scratch[0] = start_distance_m(input, desired_shape(input.desired, input.chain));
  }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    const LinkArray final_rad = desired_shape(input.desired, input.chain);
    double& left_m = body.scratch[0];
    left_m = std::max(0.0, left_m - input.desired.slide_m_s * input.dt_s);
    advance_wave(input, 0.0, body);
    // The arc moves continuously at this rate. The trajectory's own rate matters only if the body was bent before.
    const double rate_rad_s =
        std::max(desired_shape_rate(input), 2.0 * input.desired.slide_m_s / input.chain.link_length_m());
    advance_shape(input, input.chain.slid(final_rad, left_m), rate_rad_s, body);
    ride(input, final_rad, body, setpoints);
    const double whole_m = start_distance_m(input, final_rad);
    return {left_m <= 0.0, whole_m > 0.0 ? std::clamp(1.0 - left_m / whole_m, 0.0, 1.0) : 1.0};
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_wrap() { return std::make_unique<Wrap>(); }

}  // namespace constrictor
