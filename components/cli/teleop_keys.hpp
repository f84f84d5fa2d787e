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

/// Cuts what is typed into keys: one byte, or an escape sequence (arrows and other special keys). What came of a sequence waits for
/// the rest: terminals, tmux and SSH cut it anywhere, and send many at once.
class KeyReader {
 public:
  void add(std::string_view bytes) { typed_ += bytes; }
  /// The next key, empty if there is none yet. `quiet`: nothing came for a while, so that an escape which waits was the key itself.
  [[nodiscard]] std::string next(bool quiet = false);
  /// Forgets what was not taken.
  void clear() { typed_.clear(); }

 private:
  std::string typed_;
};

/// What a key of KeyReader means. The escape key means nothing: it might be what is left of a sequence.
TeleopAction action_of(std::string_view key);

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
