// "hold" keeps the posture that was measured when the motion began. If the trajectory names the posture of a U and a
// torque limit, this limit applies to the base of the U.
#include "control/wave_motion.hpp"
#include "robot/joint_limits.hpp"

namespace constrictor {
namespace {

class Hold : public ControlMethod {
 public:
  std::string_view name() const override { return "hold"; }
  void start(const MethodInput& input, BodyState& body) const override {
    // If setpoint and measured angle agree, the setpoint is held: otherwise a loaded servo would creep by its own
    // error with each new hold.
    for (std::size_t j = 0; j < input.robot.joints.size(); ++j) {
      const double deviation_rad = input.commanded_rad[j] - input.measured_rad[j];
      const bool agrees = deviation_rad < kAgreement_rad && deviation_rad > -kAgreement_rad;
      body.held_rad[j] = agrees ? input.commanded_rad[j] : input.measured_rad[j];
    }
  }
  MethodProgress step(const MethodInput& input, BodyState& body, Setpoints& setpoints) const override {
    const LinkArray shape_rad = desired_shape(input.desired, input.chain);
    for (std::size_t j = 0; j < input.robot.joints.size(); ++j) {
      setpoints.position_rad[j] = body.held_rad[j];
      setpoints.torque_limit_nm[j] = input.robot.joints[j].max_torque_nm;
    }
    for (std::size_t k = 0; k < input.chain.joint_count(); ++k) {
      if (input.desired.torque_limit_nm > 0.0 && is_base(input, shape_rad[k])) {
        setpoints.torque_limit_nm[input.chain.joint_index(k)] = input.desired.torque_limit_nm;
      }
    }
    body.frequency_hz = 0.0;
    return {true, 1.0};
  }
};

}  // namespace

std::unique_ptr<ControlMethod> make_hold() { return std::make_unique<Hold>(); }

}  // namespace constrictor
