// Plays the surroundings of a control: ideal joints, and a navigation and an input layer that do what the checks say.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "conform/part_port.hpp"
#include "robot/robot_model.hpp"

namespace constrictor::conform {

/// The messages of one tick.
struct ControlStep {
  std::int64_t tick = 0;
  std::vector<msg::JointCommand> commands;  ///< one in each tick, from a right control
  std::vector<msg::MotionStatus> states;
  std::vector<double> measured_rad;  ///< the measured angles that control received before it wrote these
};

class ControlHand {
 public:
  ControlHand(PartPort& port, const RobotModel& robot);

  /// Goes on for `seconds` with the present trajectory, authority and joints. Returns all ticks.
  std::vector<ControlStep> run(double seconds);

  /// The trajectory that navigation writes in every tick; empty: it is silent.
  std::optional<msg::DesiredTrajectory> desired;
  msg::Authority authority{};
  /// Joints that joint_state claims to have, in place of the robot's; 0: the right number.
  std::size_t false_joint_count = 0;
  /// True: the joints stay where they are, whatever is commanded.
  bool stuck = false;

  /// Begins a new motion of this kind. The trajectory has no posture and stands still.
  msg::DesiredTrajectory& begin(const std::string& motion);
  [[nodiscard]] const std::vector<double>& measured_rad() const { return measured_rad_; }
  /// The joints jump to another posture, as a relaxed body does when a person picks it up.
  void displace(const std::vector<double>& posture_rad) { measured_rad_ = posture_rad; }
  /// A posture that is not straight and in which no two joints are equal. `scale`: at most this angle [rad].
  [[nodiscard]] std::vector<double> posture(double scale_rad) const;
  /// Begins a new epoch. The next motion has the number 1 again.
  void begin_epoch();

 private:
  void send(std::int64_t count);
  PartPort& port_;
  const RobotModel& robot_;
  std::vector<double> measured_rad_, velocity_rad_s_;
  std::uint64_t motions_ = 0;
  std::int64_t steps_ = 0;
  std::vector<double> shown_rad_;  ///< in the previous tick
};

}  // namespace constrictor::conform
