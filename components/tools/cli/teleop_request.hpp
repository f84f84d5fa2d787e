// The requests of `constrictor teleop`, by keyboard and by gamepad.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "cli/teleop_keys.hpp"
#include "client/request_client.hpp"

namespace constrictor::cli {

/// A request that was sent.
struct SentRequest {
  std::string what;          ///< its name for people: "wrap left"
  std::uint64_t number = 0;  ///< of RequestClient
};

/// Sends the request of an action that stands for one by itself. Empty for actions that change a drive, open the prompt
/// or quit. `look_rad`: the angle of the head after the action.
std::optional<SentRequest> send_request(RequestClient& client, TeleopAction action, double look_rad);

}  // namespace constrictor::cli
