// Which stick and which button of a gamepad does what: a YAML file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "cli/teleop_keys.hpp"

namespace constrictor::cli {

/// One axis of a gamepad and what its full deflection means.
struct GamepadAxis {
  std::uint16_t code = 0;    ///< ABS_... of Linux
  double largest = 0;        ///< [m/s] or [rad/s] at full deflection
  bool invert = false;       ///< full deflection is the smallest raw value
  double dead_zone = 0.1;    ///< share of the deflection that counts as none
  std::int32_t minimum = 0;  ///< raw values, of a stream that does not know them; equal: not given
  std::int32_t maximum = 0;
};

struct GamepadMapping {
  std::uint16_t dead_man = 0;  ///< BTN_... that must be held: without it the robot stands
  GamepadAxis drive;           ///< [m/s] forwards
  GamepadAxis turn;            ///< [rad/s] to the left
  std::map<std::uint16_t, TeleopAction> buttons;

  /// Reads a file. Throws ConfigurationError with file, line, key, what was found and what is accepted.
  static GamepadMapping load(const std::filesystem::path& file);
  /// The mapping that is used without --mapping.
  static std::filesystem::path default_file();
};

/// "ABS_X", "BTN_SOUTH"; "code 12" if the code has no name. `type`: EV_ABS or EV_KEY.
[[nodiscard]] std::string event_code_name(unsigned type, std::uint16_t code);

}  // namespace constrictor::cli
