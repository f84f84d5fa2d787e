// What a plant does with the commands it gets: the last line between anybody's mistake and the servos. Used by the simulated plant
// and by a driver of real servos alike. Time is an argument, counted in ticks.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "robot/joint_limits.hpp"

namespace constrictor {

/// How long silence is borne.
struct ServoGuardLimits {
  std::int64_t stale_after_ticks = 5;    ///< a command older than this is not obeyed any more: the posture is held
  std::int64_t relax_after_ticks = 250;  ///< ... and after this long without an acceptable command the joints relax
};

class ServoGuard {
 public:
  enum class Mode : std::uint8_t { kObeying, kHolding, kRelaxed };

  ServoGuard(const RobotModel& robot, ServoGuardLimits limits);

  /// A command as it arrived, `age_ticks` after it was written. Not accepted, as a whole, if the count of joints differs or any
  /// setpoint is not acceptable (joint_limits.hpp). Returns the reason, empty if it was accepted.
  std::string_view offer(std::int64_t age_ticks, std::span<const double> position_rad,
                         std::span<const double> velocity_rad_s, std::span<const double> torque_limit_nm);

  /// Setpoints for the tick that begins, after at most one offer() since the previous call: the accepted command, else the
  /// posture measured when obedience ended, at the joints' full torque, else relaxed joints.
  const std::vector<JointSetpoint>& setpoints(std::span<const double> measured_rad);

  [[nodiscard]] Mode mode() const { return mode_; }
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  std::vector<JointModel> joints_;
  ServoGuardLimits limits_;
  Mode mode_ = Mode::kHolding;
  bool posture_known_ = false;            ///< of the hold in force
  bool accepted_ = false;                 ///< since the last setpoints()
  std::int64_t silent_ticks_ = 0;         ///< ticks without an acceptable command
  std::uint64_t refused_ = 0;
  std::vector<JointSetpoint> offered_;
  std::vector<JointSetpoint> setpoints_;
};

}  // namespace constrictor
