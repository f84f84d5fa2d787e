// Holds and moves the joints of a plant, slowly, and notes what the plant measures meanwhile.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "conform/plant_port.hpp"
#include "conform/plant_profile.hpp"

namespace constrictor::conform {

/// A sample during a motion.
struct Instant {
  double time_s = 0.0;        ///< end of the period in which it arrived
  double setpoint_rad = 0.0;  ///< of the joint that moves, in that period
  JointSample sample;         ///< if none arrived in a period, the newest one again
};

class PlantHand {
 public:
  PlantHand(PlantPort& port, const RobotModel& robot, const PlantProfile& profile);

  /// Goes on for `seconds` without commands. Returns all samples.
  std::vector<JointSample> watch(double seconds);
  /// Goes on for `seconds`, sending these commands in each period. Returns all samples.
  std::vector<JointSample> send(const std::vector<PlantCommand>& commands, double seconds);
  std::vector<JointSample> hold(double seconds) { return send({command()}, seconds); }
  /// Moves one setpoint at the rate of the profile to `goal_rad`, then holds for the settling time. Ends early, holding
  /// the measured posture, when any joint is more than three amplitudes away from its setpoint: `*escaped` is then
  /// true.
  std::vector<Instant> move(std::size_t joint, double goal_rad, bool* escaped = nullptr);
  /// Moves all setpoints together at the rate of the profile, then holds for the settling time.
  void return_to(const std::vector<double>& goals_rad);
  /// The setpoints become the measured posture.
  void begin_at_posture();

  /// The command of the present setpoints.
  [[nodiscard]] PlantCommand command() const;
  [[nodiscard]] double setpoint_rad(std::size_t joint) const { return setpoints_rad_[joint]; }
  void limit_torque(std::size_t joint, double limit_nm) { limits_nm_[joint] = limit_nm; }
  void restore_torque();
  /// Mean angles of some samples. Those of another size are left out.
  [[nodiscard]] std::vector<double> mean_rad(const std::vector<JointSample>& samples) const;
  /// A goal one amplitude away from the setpoint, in the direction in which there is more room.
  [[nodiscard]] double goal_rad(std::size_t joint) const;
  [[nodiscard]] const std::optional<JointSample>& newest() const { return newest_; }
  [[nodiscard]] const std::vector<ImuSample>& imus() const { return imus_; }              ///< all so far, at most 1000
  [[nodiscard]] const std::vector<ContactSample>& contacts() const { return contacts_; }  ///< likewise

 private:
  void advance(const std::vector<PlantCommand>& commands, std::vector<JointSample>* samples);
  PlantPort& port_;
  const RobotModel& robot_;
  const PlantProfile& profile_;
  std::vector<double> setpoints_rad_, limits_nm_;
  std::optional<JointSample> newest_;
  std::vector<ImuSample> imus_;
  std::vector<ContactSample> contacts_;
};

}  // namespace constrictor::conform
