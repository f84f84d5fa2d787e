// The joints of the example: a kinematic model instead of real servos, and the rules for every process that drives
// joints for `plant_relay` (idl/README.md, "Hardware topics"). It contains no DDS code. For a robot of your own,
// replace move() and the measurements.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace example {

/// A command as it arrived. One entry for each joint.
struct Command {
  std::uint64_t session = 0;
  std::uint64_t number = 0;
  bool relaxed = false;
  bool torque = false;     ///< the joints exert torque_nm; the positions do not count
  bool mode_known = true;  ///< follow, relaxed or torque
  std::vector<double> position_rad, torque_limit_nm, torque_nm;
};

class Joints {
 public:
  explicit Joints(std::size_t count) : position_rad_(count), velocity_rad_s_(count), torque_nm_(count), goal_(count) {
    limit_nm_.resize(count);
    push_nm_.resize(count);
  }

  /// Takes a command that arrived at `now_s`. Returns whether it is obeyed: a command that is old, or of which any
  /// value is absurd, is ignored as a whole.
  bool take(const Command& command, double now_s) {
    const bool silent = now_s - heard_s_ > kSilence_s;
    // Another relay takes over only when the one before is silent: two of them must not pull at the joints.
    if (command.session == 0 || (command.session != session_ && session_ != 0 && !silent)) return false;
    if (command.session == session_ && command.number <= number_) return false;
    if (!command.mode_known) return false;
    const std::size_t count = position_rad_.size();
    if (command.position_rad.size() != count || command.torque_limit_nm.size() != count ||
        command.torque_nm.size() != count)
      return false;
    for (std::size_t i = 0; i < count; ++i) {
      const double goal_rad = command.position_rad[i];
      const double limit_nm = command.torque_limit_nm[i];
      if (!std::isfinite(goal_rad) || !std::isfinite(command.torque_nm[i])) return false;
      if (!command.torque && std::abs(goal_rad) > kLimit_rad + 1e-6) return false;
      if (!std::isfinite(limit_nm) || limit_nm < 0.0) return false;
    }
    session_ = command.session;
    number_ = command.number;
    heard_s_ = now_s;
    goal_ = command.position_rad;
    limit_nm_ = command.torque_limit_nm;
    torque_mode_ = command.torque;
    for (std::size_t i = 0; i < count; ++i)
      push_nm_[i] = std::clamp(command.torque_nm[i], -command.torque_limit_nm[i], command.torque_limit_nm[i]);
    if (command.relaxed) std::fill(limit_nm_.begin(), limit_nm_.end(), 0.0);
    return true;
  }

  /// Moves the joints to the instant `now_s`.
  void move(double now_s) {
    const double passed_s = moved_s_ < 0.0 ? 0.0 : now_s - moved_s_;
    moved_s_ = now_s;
    // Without commands for this time the joints hold where they are: the relay has died, or the network is cut.
    const bool silent = session_ == 0 || now_s - heard_s_ > kSilence_s;
    if (silent && !holding_) {
      goal_ = position_rad_;
      torque_mode_ = false;  // a torque without a controller must end
    }
    holding_ = silent;
    for (std::size_t i = 0; i < position_rad_.size(); ++i) {
      if (torque_mode_) {
        push(i, passed_s);
        continue;
      }
      const double error_rad = goal_[i] - position_rad_[i];
      const double largest_rad = limit_nm_[i] > 0.0 ? kSpeed_rad_s * passed_s : 0.0;
      const double step_rad = std::clamp(error_rad, -largest_rad, largest_rad);
      position_rad_[i] += step_rad;
      velocity_rad_s_[i] = passed_s > 0.0 ? step_rad / passed_s : 0.0;
      torque_nm_[i] = std::clamp(kGain_nm_rad * error_rad, -limit_nm_[i], limit_nm_[i]);
    }
  }

  [[nodiscard]] std::size_t count() const { return position_rad_.size(); }
  [[nodiscard]] double position_rad(std::size_t joint) const { return position_rad_[joint]; }
  [[nodiscard]] double velocity_rad_s(std::size_t joint) const { return velocity_rad_s_[joint]; }
  [[nodiscard]] double torque_nm(std::size_t joint) const { return torque_nm_[joint]; }
  [[nodiscard]] bool holding() const { return holding_; }
  /// The session of the newest command that was executed; 0: none.
  [[nodiscard]] std::uint64_t session() const { return session_; }
  [[nodiscard]] std::uint64_t number() const { return number_; }

 private:
  /// Moves a joint by its torque. The model has no inertia: the joint's friction rises with its rate.
  void push(std::size_t i, double passed_s) {
    const double rate_rad_s = std::clamp(push_nm_[i] / kFriction_nm_s_rad, -kSpeed_rad_s, kSpeed_rad_s);
    const double before_rad = position_rad_[i];
    position_rad_[i] = std::clamp(before_rad + rate_rad_s * passed_s, -kLimit_rad, kLimit_rad);
    velocity_rad_s_[i] = passed_s > 0.0 ? (position_rad_[i] - before_rad) / passed_s : 0.0;
    torque_nm_[i] = push_nm_[i];
  }

  static constexpr double kSilence_s = 0.1;
  static constexpr double kLimit_rad = 1.5;    // as in the robot file
  static constexpr double kSpeed_rad_s = 4.0;  // as in the robot file
  static constexpr double kGain_nm_rad = 20.0;
  static constexpr double kFriction_nm_s_rad = 2.0;

  std::vector<double> position_rad_, velocity_rad_s_, torque_nm_, goal_, limit_nm_, push_nm_;
  std::uint64_t session_ = 0, number_ = 0;
  double heard_s_ = 0.0, moved_s_ = -1.0;
  bool holding_ = true, torque_mode_ = false;
};

}  // namespace example
