// The options of `constrictor servo`, and the parts of that command that are in files of their own.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/servo/servo_access.hpp"

namespace constrictor::cli {

struct ServoOptions {
  std::string port;
  std::uint32_t baud = 4'000'000;
  bool every_baud = false;
  std::optional<int> id;
  bool all = false;
  std::string state;                               ///< of `torque`: on or off
  std::uint32_t to_baud = 0;                       ///< of `baud`
  int to = 0;                                      ///< of `id`
  std::optional<double> current_a, temperature_c;  ///< of `limits`
  int rounds = 0;                                  ///< of `monitor`; 0: until it is interrupted
};

/// Throws UsageError unless exactly one of --id and --all is given.
void require_choice(const ServoOptions& options);
/// The servos that --id or --all names. Throws UsageError if both or neither is given, and std::runtime_error if two
/// devices have the id of one of them.
[[nodiscard]] std::vector<FoundServo> chosen_servos(ServoAccess& access, const ServoOptions& options);

/// `servo scan` and `servo monitor`: they show what the devices report, and change nothing.
int scan_servos(const ServoOptions& options);
int monitor_servos(const ServoOptions& options);
/// `servo torque`.
int switch_torque(const ServoOptions& options);

}  // namespace constrictor::cli
