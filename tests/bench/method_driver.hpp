// One of control's methods in the simulated world, with control's limiter and the safety rule for torques, but without
// the component around them.
#pragma once

#include <string>
#include <vector>

#include "control/control_method.hpp"
#include "robot/robot_model.hpp"
#include "sim/world/world.hpp"

namespace constrictor {

struct MethodTrial {
  std::string method;  ///< of control
  ControlConfig config{};
  double period_s = 0.02;  ///< length of a tick
  double frequency_hz = 0.5;
  double curvature_1_m = 0.0;  ///< of the path
  double amplitude_rad = 0.5;
  double wavelength_m = 1.07;
};

class MethodDriver {
 public:
  /// `robot` must outlive the driver. Throws std::invalid_argument if control has no such method, or if the method does
  /// not accept the trial.
  MethodDriver(const RobotModel& robot, const MethodTrial& trial);

  /// The setpoints that the method demands for the measured angles [rad] and rates [rad/s] of the joints. `around`:
  /// what the method perceives; `measured_nm`: measured torques of the joints.
  std::vector<JointSetpoint> step(const JointArray& angle_rad, const JointArray& rate_rad_s,
                                  const Perceived& around = {}, const JointArray& measured_nm = {});
  /// [rad] The angles that the method wanted in the last step, before the limiter.
  [[nodiscard]] const JointArray& wanted_rad() const { return wanted_rad_; }

 private:
  const RobotModel& robot_;
  MethodTrial trial_;
  YawChain chain_;
  JointLimiter limiter_;
  MethodRegistry registry_;
  const ControlMethod* method_;
  msg::DesiredTrajectory desired_{};
  Gait gait_;
  BodyState body_;
  LimiterState limit_;
  JointArray wanted_rad_{}, exerted_nm_{};
  bool started_ = false, torque_mode_ = false;
};

}  // namespace constrictor
