// What the bridge asks of `input` when velocities come from ROS: a wish goes on being asked until it is obeyed. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "constrictor/messages.hpp"
#include "ros_bridge/ros_translator.hpp"

namespace constrictor::ros {

/// Times are those of one steady clock [s].
class VelocityPilot {
 public:
  struct Ask {
    std::uint8_t kind = msg::kRequestMotion;  ///< or kRequestRelease
    Drive drive;                              ///< of a motion; none: stand
  };
  /// Without a velocity for `hold_after_s` the robot shall stand.
  explicit VelocityPilot(double hold_after_s) : hold_after_s_(hold_after_s) {}

  /// A velocity came.
  void command(const Drive& drive, double now_s);
  /// `authority` says whether the bridge holds it, and whether an emergency stop is latched. After a stop nothing is asked before the
  /// velocity was zero or absent once: clearing the stop starts no motion.
  void authority(bool holds, bool emergency_stop, double now_s);
  /// The last request was answered.
  void answered(bool granted);
  /// What is to be asked now. `heard`: whether `input` has been met; `steered`: whether anybody writes velocities.
  /// What was refused is asked again each second, what was not answered each half second.
  [[nodiscard]] std::optional<Ask> next(bool heard, bool steered, double now_s);

 private:
  enum class Last { kNothing, kUnanswered, kGranted, kRefused };
  [[nodiscard]] bool may_ask(const Ask& ask, double now_s) const;

  double hold_after_s_;
  std::optional<Drive> wish_;
  double commanded_s_ = 0.0;
  bool holds_ = false;
  bool blocked_ = false;   ///< by an emergency stop
  Last last_ = Last::kNothing;
  Ask asked_;
  double asked_s_ = 0.0;
};

}  // namespace constrictor::ros
