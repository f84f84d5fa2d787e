// "relax" switches off the torque of every joint.
#include "control/control_method.hpp"

namespace constrictor {
namespace {

class Relax : public ControlMethod {
 public:
  std::string_view name() const override { return "relax"; }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    setpoints.position_rad = input.measured_rad;
    setpoints.torque_limit_nm = {};
    body.frequency_hz = 0.0;
    return {true, 1.0};
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_relax() { return std::make_unique<Relax>(); }

}  // namespace constrictor
