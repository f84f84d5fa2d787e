// "squeeze": the base joints of a U close by `squeeze_rad` in total, while the joint on either side of the base opens,
// so that the arms close by less than the base and leave room for a wide object. The torque is limited. Done when the
// base has closed by `squeeze_rad`; navigation stops the squeeze earlier when the forces suffice.
#include <algorithm>
#include <cmath>

#include "control/wave_motion.hpp"

namespace constrictor {
namespace {

class Squeeze : public ControlMethod {
 public:
  std::string_view name() const override { return "squeeze"; }
  bool accepts(const msg::DesiredTrajectory& desired, const YawChain& chain) const override {
    return ControlMethod::accepts(desired, chain) && desired.shape_count > 0 && desired.squeeze_rad > 0.0;
  }
  void start(const MethodInput& input, BodyState& body) const override { keep_residual(input, body); }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    const LinkArray open_rad = desired_shape(input.desired, input.chain);
    double& closed_rad = body.scratch[0];
    const double rate_rad_s =
        input.desired.shape_rate_rad_s > 0.0 ? input.desired.shape_rate_rad_s : input.config.squeeze_rate_rad_s;
    closed_rad = std::min(input.desired.squeeze_rad, closed_rad + rate_rad_s * input.dt_s);
    advance_wave(input, 1.0, body);
    advance_shape(input, closed(input, open_rad, closed_rad), input.config.shape_rate_rad_s, body);
    ride(input, open_rad, body, setpoints);
    return {closed_rad >= input.desired.squeeze_rad, closed_rad / input.desired.squeeze_rad};
  }

 private:
  static LinkArray closed(const MethodInput& input, const LinkArray& open_rad, double total_rad) {
    LinkArray shape_rad = open_rad;
    const auto base = base_of(input, open_rad);
    if (!base) return shape_rad;
    const auto [first, last] = *base;
    const double each_rad = total_rad / static_cast<double>(last - first + 1);
    const double sign = std::copysign(1.0, open_rad[first]);
    for (std::size_t k = first; k <= last; ++k) shape_rad[k] += sign * each_rad;
    const double beside_rad = 0.5 * input.config.opening_share * total_rad;
    if (first > 0) shape_rad[first - 1] -= sign * beside_rad;
    if (last + 1 < input.chain.joint_count()) shape_rad[last + 1] -= sign * beside_rad;
    return shape_rad;
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_squeeze() { return std::make_unique<Squeeze>(); }

}  // namespace constrictor
