// Direct motions: an operator or external planner moves the body without a task.
#pragma once

#include "navigation/task.hpp"

namespace constrictor {

/// The direct motion in force.
struct DirectMotionState {
  bool active = false;  ///< a direct motion, and no task, moves the body
  std::uint8_t motion = msg::kMotionStand;
  double speed_m_s = 0.0;
  double curvature_1_m = 0.0;
  double angle_rad = 0.0;
  double wrapped_side = 0.0;  ///< the body is wrapped to this side: +1 left, -1 right; 0: it is straight
  bool squeezed = false;
  bool begins = false;  ///< the present step is the first of this motion
  template <class Archive>
  void serialize(Archive& archive) {
    archive(active, motion, speed_m_s, curvature_1_m, angle_rad, wrapped_side, squeezed, begins);
  }
};

/// Begins the motion of a command; the caller has ended the running task. The motions kMotionOpen and kMotionWrap
/// release a held object.
void begin_motion(const msg::MotionCommand& command, DirectMotionState& state, Grip& grip);

/// Sets the trajectory of the present motion. A squeezed body keeps a torque cap on the base joints of the U, so that
/// it neither jams nor releases the object.
void step_motion(const NavigationConfig& config, const GripSense& sense, const Grip& grip, DirectMotionState& state,
                 TaskOutput& output);

}  // namespace constrictor
