// Checks whether a plant keeps the contract of idl/CLIENTS.md. Every motion is small and slow, and nothing moves before
// the measured posture is known.
#pragma once

#include <vector>

#include "conform/plant_hand.hpp"
#include "conform/plant_port.hpp"
#include "conform/plant_profile.hpp"
#include "conform/report.hpp"

namespace constrictor::conform {

/// All checks, in the order in which they are made.
[[nodiscard]] std::vector<Check> plant_checks();

class PlantConformance {
 public:
  /// All arguments must outlive this object. `profile` must fit the robot (PlantProfile::adapt_to).
  PlantConformance(PlantPort& port, const RobotModel& robot, const PlantProfile& profile, Report& report)
      : port_(port), robot_(robot), profile_(profile), report_(report), hand_(port, robot, profile) {}

  /// Makes all checks that can be made. Throws Interrupted and PlantGone; the report then has the results so far.
  void run();

 private:
  // Checks while the joints rest (plant_rest_checks.cpp). False: no joint may be moved.
  bool check_arrival();
  bool check_samples(const std::vector<JointSample>& samples);
  void check_stamps(const std::vector<JointSample>& samples);
  void check_rate(const std::vector<JointSample>& samples);
  void check_rest(const std::vector<JointSample>& samples);
  void check_confirmation(const std::vector<JointSample>& samples);
  void check_imu();
  void check_contacts();
  // One joint after the other (plant_motion_checks.cpp).
  struct Moved;
  void check_motions();
  Moved move_joint(std::size_t joint);
  /// What a joint bears at the end of its way more than at the start; positive along the way.
  struct JointLoad {
    std::size_t joint = 0;
    double along_nm = 0.0;
  };
  void judge_torque_sign(const std::vector<JointLoad>& loads);
  // Commands that must not be obeyed, and their absence (plant_command_checks.cpp).
  void check_commands();
  void refuses(const char* name, const PlantCommand& wrong, bool beside_proper, const char* todo);
  void check_torque_limit(std::size_t joint);
  void check_relaxed();
  // Commands that demand torques (plant_torque_checks.cpp).
  struct Pushed {
    double turned_rad = 0.0;  ///< along the torque
    std::size_t other = 0;    ///< the joint that turned most, apart from the pushed one
    double other_rad = 0.0;   ///< how far
    double demanded_nm = 0.0;
    double largest_nm = 0.0;  ///< measured
  };
  /// Pushes a joint until it turns, and moves all joints back. The other joints exert no torque.
  Pushed push_joint(std::size_t joint, double limit_nm);
  void check_torque_mode();
  void check_torque_silence(std::size_t joint);
  void check_silence(std::size_t joint);
  void check_return(std::size_t joint, const char* name, const char* todo);
  void check_stop(std::size_t joint);
  void check_epoch(std::size_t joint);
  /// Ends the commands in the middle of a motion, and waits until the joints must rest.
  void break_motion_off(std::size_t joint);
  // The end and the next start of the plant's process (plant_restart_check.cpp).
  void check_restart(std::size_t joint);
  [[nodiscard]] std::string restart_fault(const std::vector<double>& rest_rad, std::uint64_t before);
  void skip_all(const std::vector<const char*>& names, const std::string& reason);
  /// [rad] how far the joint that moved most was from its setpoint in any of the samples.
  [[nodiscard]] double strayed_rad(const std::vector<JointSample>& samples) const;

  PlantPort& port_;
  const RobotModel& robot_;
  const PlantProfile& profile_;
  Report& report_;
  PlantHand hand_;
};

}  // namespace constrictor::conform
