// swaying_control [control] OPTIONS: replaces the component `control` and moves one joint to and fro. From tick
// kFaultFrom to kFaultTo it has the fault $CONSTRICTOR_FAULT: `nan` commands an angle that is not a number, `count` a
// wrong number of joints, `silence` sends no commands. Without this variable there is no fault.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "control_main.hpp"
#include "robot/robot_model.hpp"
#include "swaying_control.hpp"

namespace {

using namespace constrictor;

class SwayingControl : public StatefulComponent<int> {
 public:
  SwayingControl(Wiring& wiring, const Setup& setup, std::string fault)
      : robot_(load_robot(setup.robot_file)),
        fault_(std::move(fault)),
        command_out_(wiring.output(topics::kJointCommand)) {}
  void step(const Tick& tick) override {
    const bool faulty = tick.index >= testing::kFaultFrom && tick.index < testing::kFaultTo;
    if (faulty && fault_ == "silence") return;
    msg::JointCommand command{};
    command.joint_count = static_cast<std::uint16_t>(robot_.joints.size());
    for (std::size_t i = 0; i < robot_.joints.size(); ++i) command.torque_limit_nm[i] = robot_.joints[i].max_torque_nm;
    command.position_rad[testing::kSwayingJoint] = testing::sway_rad(tick.index);
    if (faulty && fault_ == "nan")
      command.position_rad[testing::kSwayingJoint] = std::numeric_limits<double>::quiet_NaN();
    if (faulty && fault_ == "count") command.joint_count = 5;
    command_out_.write(command);
  }

 private:
  RobotModel robot_;
  std::string fault_;
  Output<msg::JointCommand> command_out_;
};

}  // namespace

int main(int argc, char** argv) {
  const char* fault = std::getenv("CONSTRICTOR_FAULT");
  return testing::control_main(argc, argv,
                               {"control", [fault](Wiring& wiring, const Setup& setup) -> std::unique_ptr<Component> {
                                  return std::make_unique<SwayingControl>(wiring, setup, fault ? fault : "");
                                }});
}
