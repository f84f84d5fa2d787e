// What a key of `constrictor teleop` means. Pure.
#pragma once

#include <string>
#include <string_view>

namespace constrictor::cli {

enum class TeleopAction {
  kNone,
  kForward,
  kBack,
  kLeft,         ///< turn while driving
  kRight,
  kRotateLeft,   ///< nearly on the spot
  kRotateRight,
  kStand,
  kFaster,
  kSlower,
  kLookLeft,
  kLookAhead,
  kLookRight,
  kWrapLeft,
  kWrapRight,
  kSqueeze,
  kOpen,
  kEmergencyStop,
  kClearStop,
  kTask,         ///< asks for a task and its parameters
  kCancel,       ///< of the running task
  kRelease,      ///< gives authority back
  kQuit,
};

/// Takes the next key off `typed` (an escape sequence counts as one key; a lone escape quits) and says what it means.
TeleopAction next_action(std::string_view& typed);

/// The keys for people, at most 80 columns each.
extern const char* const kTeleopHelp[3];

/// What is driven, changed by actions.
struct TeleopDrive {
  double speed_m_s = 0.3;     ///< magnitude that the driving keys use
  double forward = 0.0;       ///< +1, 0, -1
  double turn = 0.0;          ///< +1 left, -1 right
  double look_rad = 0.0;

  [[nodiscard]] double drive_m_s() const { return forward * speed_m_s; }
  [[nodiscard]] double turn_rad_s() const;
  /// Applies an action that drives; false if it is another one.
  bool apply(TeleopAction action);
};

}  // namespace constrictor::cli
