// Checks whether a control keeps the contract of idl/CLIENTS.md. No real joint moves: the checks play the plant.
#pragma once

#include <string>
#include <vector>

#include "conform/control_hand.hpp"
#include "conform/control_profile.hpp"
#include "conform/report.hpp"

namespace constrictor::conform {

/// All checks, in the order in which they are made.
[[nodiscard]] std::vector<Check> control_checks();

class ControlConformance {
 public:
  /// All arguments must outlive this object.
  ControlConformance(PartPort& port, const RobotModel& robot, const ControlProfile& profile, Report& report)
      : port_(port), robot_(robot), profile_(profile), report_(report), hand_(port, robot), yaw_(robot.yaw_joints()) {}

  /// Makes all checks that can be made. Throws PartGone; the report then has the results so far.
  void run();

 private:
  using Steps = std::vector<ControlStep>;
  static constexpr double kSilence_s = 0.5;
  // At rest (control_rest_checks.cpp). False: no other check can be made.
  bool check_arrival();
  void check_refusals();
  // Postures (control_posture_checks.cpp).
  void check_bend();
  void judge_posture(const std::vector<double>& shape_rad, const std::vector<double>& reached_rad);
  void judge_course(const Steps& steps, const std::vector<double>& shape_rad);
  void check_squeeze();
  void check_limits();
  // Undulation (control_wave_checks.cpp).
  void check_wave();
  void judge_wave(const Steps& steps);
  void judge_speed(const Steps& steps);
  void check_curvature();
  void check_stand();
  // Silence, authority, stops, epochs (control_safety_checks.cpp).
  void check_relax();
  void check_silence();
  void check_authority();
  void check_stop();
  void check_wrong_joints();
  void check_epoch();

  /// Goes on for some time, and records the extremes of all commands (the members below). Throws PartGone if a control
  /// that has written commands and states before writes none of them for this time, of kSilence_s or more.
  Steps go(double seconds);
  void refuse_silence(const Steps& steps) const;
  /// Bends the body to a posture, one angle for each yaw joint, and waits until it must have been reached.
  Steps bend(const std::vector<double>& shape_rad, double rate_rad_s);
  /// Begins to move along an arc of this curvature, without waiting.
  void travel(double speed_m_s, double curvature_1_m);
  /// [rad] how far the setpoint that moved most is from `posture_rad` in any of the ticks from `from_s` on.
  [[nodiscard]] static double strayed_rad(const Steps& steps, const std::vector<double>& posture_rad,
                                          double from_s = 0.0);
  /// [rad] by how much any setpoint changed between the ticks from `from_s` on.
  [[nodiscard]] static double moved_rad(const Steps& steps, double from_s);
  /// They point into `steps`, which must therefore not be a temporary. Not null after go(kSilence_s) or longer.
  [[nodiscard]] static const msg::JointCommand* last_command(const Steps& steps);
  [[nodiscard]] static const msg::MotionStatus* last_state(const Steps& steps);
  static void last_command(Steps&&) = delete;
  static void last_state(Steps&&) = delete;
  /// [rad] the setpoints of the yaw joints, from the head.
  [[nodiscard]] std::vector<double> yaw_angles(const msg::JointCommand& command) const;

  PartPort& port_;
  const RobotModel& robot_;
  const ControlProfile& profile_;
  Report& report_;
  ControlHand hand_;
  std::vector<std::size_t> yaw_;
  bool arrived_ = false;  ///< the control has written commands and states
  bool bends_ = false, travels_ = false;
  double rate_hz_ = 0.0;  ///< of the undulation at the speed of the profile, as motion_status states it
  // Checks of every command.
  bool judges_rate_ = true;
  std::vector<double> previous_rad_;       ///< setpoints of the last command; empty: none, or the joints were displaced
  double largest_rate_ = 0.0;              ///< of a setpoint, as a share of its joint's largest speed
  std::size_t fastest_ = 0;                ///< the joint of this setpoint
  double beyond_rad_ = 0.0;                ///< of a joint's limits
  double beyond_nm_ = 0.0;                 ///< of a joint's torque
  std::size_t unlike_ = 0, compared_ = 0;  ///< velocities unlike their setpoint's rate; all compared
};

}  // namespace constrictor::conform
