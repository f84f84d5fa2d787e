// Control in an in-process run, with ideal servos as the plant and a scripted trajectory.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "barrier/local_run.hpp"
#include "component/data_path.hpp"
#include "control/control.hpp"
#include "support/scripted_members.hpp"

namespace constrictor {

/// Joints that reach every commanded position at once.
class IdealServos : public testing::PlantBase {
 public:
  IdealServos(Wiring& wiring, const Setup&)
      : command_(wiring.latest(topics::kJointCommand)), joints_(wiring.output(topics::kJointState)) {
    state_.joint_count = 23;
    state_.position_rad[6] = 0.4;
  }
  void sample(const Tick&) override { joints_.write(state_); }
  void step(const Tick&) override {
    if (!command_) return;
    for (int j = 0; j < 23; ++j) {
      if (command_->torque_limit_nm[j] > 0.0) state_.position_rad[j] = command_->position_rad[j];
    }
  }

 private:
  Latest<msg::JointCommand> command_;
  Output<msg::JointState> joints_;
  msg::JointState state_{};
};

using Script = std::function<bool(const Tick&, msg::DesiredTrajectory&)>;

/// Stands for navigation: writes the trajectory that the script fills in, where it returns true.
inline ComponentFactory scripted_navigation(Script script) {
  return testing::scripted_writer<msg::DesiredTrajectory>(
      "navigation", topics::kDesiredTrajectory, [script = std::move(script)](const Tick& tick, const auto& out) {
        msg::DesiredTrajectory desired{};
        if (script(tick, desired)) out.write(desired);
      });
}

/// `motion`: a kind of motion, or the name of a control method.
inline void set_motion(msg::DesiredTrajectory& desired, const char* motion, std::uint64_t motion_id) {
  std::snprintf(desired.motion, sizeof desired.motion, "%s", motion);
  desired.motion_id = motion_id;
}

inline void set_u(msg::DesiredTrajectory& desired) {
  desired.shape_count = 12;
  for (int k = 5; k <= 7; ++k) desired.shape_rad[k] = 1.047;
}

/// A run of control with a plant and a script. `more`: additional components.
template <class Servos = IdealServos>
LocalRun make_run(Script script, ComponentFactory control = make_control_factory(),
                  std::vector<ComponentFactory> more = {}) {
  Setup setup;
  setup.robot_file = data_path("components/lib/robot/mamba.yaml");
  more.insert(more.begin(), testing::member_of_class<Servos>("physics"));
  more.push_back(std::move(control));
  more.push_back(scripted_navigation(std::move(script)));
  return LocalRun(more, setup);
}

/// Largest change of any setpoint from one tick to the next, over a run.
inline double largest_step_rad(LocalRun& run, int ticks) {
  double largest = 0.0;
  msg::JointCommand previous = *run.latest(topics::kJointCommand);
  for (int i = 0; i < ticks; ++i) {
    run.advance(1);
    const msg::JointCommand& now = *run.latest(topics::kJointCommand);
    for (int j = 0; j < 23; ++j) largest = std::max(largest, std::abs(now.position_rad[j] - previous.position_rad[j]));
    previous = now;
  }
  return largest;
}

}  // namespace constrictor
