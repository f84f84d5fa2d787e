// The plant of a robot that lies still.
#pragma once

#include "support/scripted_members.hpp"

namespace constrictor::testing {

/// A robot of 23 straight joints that does not move: joint states and attitude in each tick, no contacts.
inline ComponentFactory still_plant() {
  return scripted_plant([](Wiring& wiring) -> StepFunction {
    return [joints = wiring.output(topics::kJointState), imu = wiring.output(topics::kImuState)](const Tick&) {
      msg::JointState state{};
      state.joint_count = 23;
      joints.write(state);
      msg::ImuState attitude{};
      attitude.orientation.w = 1.0;
      imu.write(attitude);
    };
  });
}

}  // namespace constrictor::testing
