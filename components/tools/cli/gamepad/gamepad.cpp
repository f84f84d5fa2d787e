#include "cli/gamepad/gamepad.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace constrictor::cli {
namespace {

constexpr AxisRange kUsual{-32768, 32767};

AxisRange range_of(const GamepadAxis& axis, const std::map<std::uint16_t, AxisRange>& ranges) {
  if (axis.minimum < axis.maximum) return {axis.minimum, axis.maximum};
  const auto known = ranges.find(axis.code);
  return known != ranges.end() && known->second.minimum < known->second.maximum ? known->second : kUsual;
}

/// Whether the action is accepted without the dead-man button: it moves nothing.
bool is_always_allowed(TeleopAction action) {
  return action == TeleopAction::kEmergencyStop || action == TeleopAction::kClearStop ||
         action == TeleopAction::kRelease;
}

}  // namespace

Gamepad::Gamepad(GamepadMapping mapping, const std::map<std::uint16_t, AxisRange>& ranges)
    : mapping_(std::move(mapping)),
      drive_range_(range_of(mapping_.drive, ranges)),
      turn_range_(range_of(mapping_.turn, ranges)) {}

double Gamepad::deflection(const GamepadAxis& axis, const AxisRange& range, std::int32_t value) const {
  const double middle = 0.5 * (static_cast<double>(range.minimum) + static_cast<double>(range.maximum));
  const double half = static_cast<double>(range.maximum) - middle;
  const double share = std::clamp((static_cast<double>(value) - middle) / half, -1.0, 1.0) * (axis.invert ? -1.0 : 1.0);
  const double beyond = (std::abs(share) - axis.dead_zone) / (1.0 - axis.dead_zone);
  return beyond <= 0.0 ? 0.0 : std::copysign(beyond, share) * axis.largest;
}

void Gamepad::take(std::uint16_t type, std::uint16_t code, std::int32_t value) {
  if (type == EV_SYN && code == SYN_DROPPED) {
    lost();
    dropped_ = true;
  } else if (type == EV_SYN && code == SYN_REPORT) {
    if (!std::exchange(dropped_, false)) {
      for (const TeleopAction action : pressed_) {
        if (next_.held || is_always_allowed(action)) actions_.push_back(action);
      }
      if (now_.held && !next_.held) released_ = true;
      now_ = next_;
    }
    pressed_.clear();
  } else if (dropped_) {
    return;
  } else if (type == EV_KEY && code == mapping_.dead_man) {
    if (value != 2) next_.held = value == 1;  // 2 is the repetition of a key
  } else if (type == EV_KEY && value == 1) {
    if (const auto found = mapping_.buttons.find(code); found != mapping_.buttons.end())
      pressed_.push_back(found->second);
  } else if (type == EV_ABS && code == mapping_.drive.code) {
    next_.drive_m_s = deflection(mapping_.drive, drive_range_, value);
  } else if (type == EV_ABS && code == mapping_.turn.code) {
    next_.turn_rad_s = deflection(mapping_.turn, turn_range_, value);
  }
}

void Gamepad::lost() {
  released_ = true;
  now_ = next_ = {};
  pressed_.clear();
}

std::vector<TeleopAction> Gamepad::take_actions() { return std::exchange(actions_, {}); }

}  // namespace constrictor::cli
