// Which requests the bridge sends when velocities come from ROS 2. Pure: time is an argument.
#pragma once

#include <cstdint>
#include <optional>

#include "constrictor/messages.hpp"
#include "ros_bridge/ros_translator.hpp"

namespace constrictor::ros_bridge {

/// Repeats the request for the newest velocity until `input` grants it. All times are of one steady clock [s].
class VelocityPilot {
 public:
  struct Ask {
    std::uint8_t kind = msg::kRequestMotion;  ///< or kRequestRelease
    Drive drive;                              ///< of a motion; none: stand
  };
  /// The robot stands when no velocity has come for `hold_after_s`.
  explicit VelocityPilot(double hold_after_s) : hold_after_s_(hold_after_s) {}

  /// To be called for each velocity that arrives.
  void command(const Drive& drive, double now_s);
  /// To be called with the newest authority: whether the bridge has it, and whether an emergency stop is latched. After
  /// a stop there is no request until the velocity was zero or absent once, so that clearing the stop starts no motion.
  void authority(bool holds, bool emergency_stop, double now_s);
  /// To be called with whether a task that a ROS program requested runs. When one begins, the pilot forgets the
  /// velocity before it: the newest command counts. While it runs, a velocity of zero is ignored unless another
  /// velocity came before, because many ROS programs write zeros all the time.
  void task(bool runs);
  /// To be called when the last request is answered.
  void answered(bool granted);
  /// The request to send now; empty: none. `connected`: `input` reads requests. `steered`: some process writes
  /// velocities. A refused request is repeated each second, an unanswered one each half second.
  [[nodiscard]] std::optional<Ask> next(bool connected, bool steered, double now_s);

 private:
  enum class Last { kNothing, kUnanswered, kGranted, kRefused };
  [[nodiscard]] bool may_ask(const Ask& ask, double now_s) const;

  double hold_after_s_;
  std::optional<Drive> wanted_;
  double commanded_s_ = 0.0;  ///< time of the last velocity
  bool holds_ = false;
  bool blocked_ = false;  ///< by an emergency stop
  bool task_runs_ = false;
  Last last_ = Last::kNothing;
  Ask asked_;
  double asked_s_ = 0.0;
};

}  // namespace constrictor::ros_bridge
