// Drives the simulated robot by the same wave with angles or with torques, and measures how well the joints follow it.
// Commands act one tick after the measurement, as in a run.
#pragma once

#include <string>
#include <vector>

#include "control/control_method.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::sliding_mode {

struct Trial {
  std::string method = "undulation";  ///< of control
  ControlConfig config{};
  double period_s = 0.02;       ///< length of a tick
  double frequency_hz = 0.7;    ///< of the wave, as navigation travels
  double duration_s = 16.0;     ///< the first kSettle_s are not measured
  double friction_share = 1.0;  ///< of the skin's friction that the robot file states
  double mass_share = 1.0;      ///< likewise; control goes on counting with the robot file
  double curvature_1_m = 0.0;   ///< of the path
};

/// A moment of one joint.
struct Moment {
  double time_s = 0.0;
  double reference_rad = 0.0, angle_rad = 0.0;
};

struct Tracking {
  double error_rad = 0.0;      ///< rms over the yaw joints
  double heading_rad = 0.0;    ///< rms of the heading of the line from tail to head about its mean
  double torque_nm = 0.0;      ///< rms over all joints and steps
  double speed_m_s = 0.0;      ///< of the body's middle, along a straight line
  double raised_m = 0.0;       ///< largest height of a module's centre above its height on the ground
  double power_w = 0.0;        ///< positive work of the joints in a second
  std::vector<Moment> course;  ///< of the yaw joint in the middle of the body
};

inline constexpr double kSettle_s = 4.0;

/// Sensor noise of the angles is that of the robot file, from a fixed seed.
[[nodiscard]] Tracking run(const RobotModel& robot, const Trial& trial);

}  // namespace constrictor::sliding_mode
