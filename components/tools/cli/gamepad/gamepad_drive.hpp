// `constrictor teleop --gamepad`: drives the robot with a gamepad, without a screen.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace constrictor::cli {

struct GamepadOptions {
  std::string device;   ///< path, or "auto"
  std::string mapping;  ///< path; empty: GamepadMapping::default_file()
};

/// Drives until Ctrl-C or the end of the run. The robot moves only while the dead-man button is held; it stands when
/// the button is released, and holds when the gamepad is gone. Returns the exit status. Throws ConfigurationError,
/// CommandError, or std::runtime_error if the gamepad cannot be used.
int gamepad_drive(const GamepadOptions& options, std::optional<std::uint32_t> run);

}  // namespace constrictor::cli
