// The keys of `constrictor teleop` and their actions. Pure.
#pragma once

#include <string>
#include <string_view>

namespace constrictor::cli {

enum class TeleopAction {
  kNone,
  kForward,
  kBack,
  kLeft,  ///< turn while driving
  kRight,
  kRotateLeft,  ///< turn nearly on the spot
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
  kTask,     ///< opens the prompt for a task
  kCancel,   ///< cancels the running task
  kRelease,  ///< releases authority
  kQuit,
};

/// Splits typed bytes into keys. A key is one byte, or an escape sequence (arrows and other special keys). An
/// incomplete sequence is kept until its rest arrives, because terminals, tmux and SSH split sequences anywhere and may
/// send several at once.
class KeyReader {
 public:
  void add(std::string_view bytes) { typed_ += bytes; }
  /// The next key; empty if there is none yet. `quiet`: no byte has come for a while, so a waiting escape character was
  /// the escape key.
  [[nodiscard]] std::string next(bool quiet = false);
  /// Discards the bytes that are left.
  void clear() { typed_.clear(); }

 private:
  std::string typed_;
};

/// The action of a key from KeyReader. The escape key has none: it may be the rest of a sequence.
TeleopAction action_of(std::string_view key);

/// The keys and their actions for people, at most 80 columns each; the last line has the emergency stop.
extern const char* const kTeleopHelp[3];

/// The motion that the operator has chosen.
struct TeleopDrive {
  double speed_m_s = 0.3;  ///< [m/s] speed of the driving keys, always positive
  double forward = 0.0;    ///< +1 forwards, 0, -1 backwards
  double turn = 0.0;       ///< +1 left, -1 right
  double look_rad = 0.0;

  [[nodiscard]] double drive_m_s() const { return forward * speed_m_s; }
  [[nodiscard]] double turn_rad_s() const;
  /// Applies an action that changes the drive and returns true; returns false for other actions.
  bool apply(TeleopAction action);
};

}  // namespace constrictor::cli
