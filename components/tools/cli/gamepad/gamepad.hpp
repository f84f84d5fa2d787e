// Translates the events of a gamepad into commands to the robot. Pure: no device, no DDS, no clock.
#pragma once

#include <linux/input.h>

#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "cli/gamepad/mapping.hpp"

namespace constrictor::cli {

/// Raw values of an axis at both ends.
struct AxisRange {
  std::int32_t minimum = 0;
  std::int32_t maximum = 0;
};

/// The state of a gamepad after the events so far.
class Gamepad {
 public:
  /// `ranges`: of the device's axes, by their code; the mapping's own minimum and maximum come first. An axis without
  /// a range has -32768 to 32767, as most gamepads.
  Gamepad(GamepadMapping mapping, const std::map<std::uint16_t, AxisRange>& ranges);

  /// Takes one event. Values take effect at the next SYN_REPORT. SYN_DROPPED means that events were lost: then nothing
  /// is held any more, and everything up to the next SYN_REPORT is ignored.
  void take(std::uint16_t type, std::uint16_t code, std::int32_t value);
  /// The device is gone: nothing is held any more.
  void lost();

  /// Whether the dead-man button is held. A button that was held when the device was opened does not count: it must be
  /// pressed while this program looks.
  [[nodiscard]] bool held() const { return now_.held; }
  /// [m/s] forwards; 0 unless the dead-man button is held.
  [[nodiscard]] double drive_m_s() const { return now_.held ? now_.drive_m_s : 0.0; }
  /// [rad/s] to the left; 0 unless the dead-man button is held.
  [[nodiscard]] double turn_rad_s() const { return now_.held ? now_.turn_rad_s : 0.0; }
  /// Whether the dead-man button has been released since the last call, however shortly.
  [[nodiscard]] bool take_released() { return std::exchange(released_, false); }
  /// The actions of the buttons that were pressed since the last call, in the order of the presses. While the dead-man
  /// button is not held, only emergency stop, clear stop and release count.
  [[nodiscard]] std::vector<TeleopAction> take_actions();

 private:
  struct State {
    bool held = false;
    double drive_m_s = 0;
    double turn_rad_s = 0;
  };
  [[nodiscard]] double deflection(const GamepadAxis& axis, const AxisRange& range, std::int32_t value) const;

  GamepadMapping mapping_;
  AxisRange drive_range_;
  AxisRange turn_range_;
  State now_;
  State next_;  ///< at the next SYN_REPORT
  bool dropped_ = false;
  bool released_ = false;
  std::vector<TeleopAction> pressed_;  ///< since the last SYN_REPORT
  std::vector<TeleopAction> actions_;
};

}  // namespace constrictor::cli
