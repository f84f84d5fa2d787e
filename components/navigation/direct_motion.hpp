// What an operator or external planner asks the body to do now, outside of any task.
#pragma once

#include "navigation/task.hpp"

namespace constrictor {

/// The direct motion in force.
struct DirectMotionState {
  bool active = false;         ///< a direct motion, and no task, says what the body does
  std::uint8_t motion = msg::kMotionStand;
  double frequency_hz = 0.0;
  double curvature_1_m = 0.0;
  double angle_rad = 0.0;
  double wrapped_side = 0.0;   ///< +1, -1: the body was wrapped to that side and not opened since; 0: straight
  bool squeezed = false;
  bool begins = false;         ///< the present step is its first
  template <class Archive>
  void serialize(Archive& archive) {
    archive(active, motion, frequency_hz, curvature_1_m, angle_rad, wrapped_side, squeezed, begins);
  }
};

/// Takes a command over. Whatever ran before has ended. `open` lets go of what a task has grasped, `wrap` begins anew.
void begin_motion(const msg::MotionCommand& command, DirectMotionState& state, Grip& grip);

/// The trajectory of the present motion. Squeezing and driving wrapped cap the torque of the U's base joints, so that the body
/// neither jams nor lets go.
void step_motion(const NavigationConfig& config, const GripSense& sense, const Grip& grip,
                 DirectMotionState& state, TaskOutput& output);

}  // namespace constrictor
