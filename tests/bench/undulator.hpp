// Replaces the component `control` by the open-loop gait.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "component/component.hpp"
#include "unit/world/open_loop_gait.hpp"

namespace constrictor::bench {

class Undulator final : public Component {
 public:
  Undulator(Wiring& wiring, const Setup& setup)
      : robot_(load_robot(setup.robot_file)), output_(wiring.output(topics::kJointCommand)) {}
  void step(const Tick& tick) override {
    msg::JointCommand command{};
    const std::vector<double> angles = gait_.angles(robot_, tick.time_s());
    const std::vector<double> next = gait_.angles(robot_, tick.time_s() + tick.period_s());
    command.joint_count = static_cast<std::uint16_t>(angles.size());
    for (std::size_t i = 0; i < angles.size(); ++i) {
      command.position_rad[i] = angles[i];
      command.velocity_rad_s[i] = (next[i] - angles[i]) / tick.period_s();
      command.torque_limit_nm[i] = robot_.joints[i].max_torque_nm;
    }
    output_.write(command);
  }
  [[nodiscard]] std::string save() const override { return {}; }
  void load(const std::string&) override {}

 private:
  RobotModel robot_;
  OpenLoopGait gait_;
  Output<msg::JointCommand> output_;
};

inline ComponentFactory undulator() {
  return {"control", [](Wiring& wiring, const Setup& setup) { return std::make_unique<Undulator>(wiring, setup); }};
}

}  // namespace constrictor::bench
