// `constrictor teleop --drive`: drives the robot from a script, without a screen.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace constrictor::cli {

/// Period of the loops of `teleop`; much shorter than the lease of its authority.
inline constexpr std::chrono::milliseconds kTeleopTurn{50};

/// If this process is dead or hangs for this time, `input` takes its authority away and the robot holds its posture.
/// The time is long enough for a busy host, and short enough for the safety of a person beside the robot.
inline constexpr std::chrono::milliseconds kTeleopLease{500};

/// Drives with `speed_and_turn`, "SPEED,TURN" in m/s and rad/s, for `duration` of wall time (empty: until Ctrl-C); then
/// stands and releases authority, also after Ctrl-C. Returns the exit status. Throws UsageError and CommandError.
int teleop_drive(const std::string& speed_and_turn, const std::string& duration, std::optional<std::uint32_t> run);

}  // namespace constrictor::cli
