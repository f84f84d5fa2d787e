#include "cli/teleop_request.hpp"

namespace constrictor::cli {

std::optional<SentRequest> send_request(RequestClient& client, TeleopAction action, double look_rad) {
  using enum TeleopAction;
  switch (action) {
    case kStand:
      return SentRequest{"stand", client.move(msg::kMotionStand)};
    case kCancel:
      return SentRequest{"cancel: stand", client.move(msg::kMotionStand)};
    case kLookLeft:
    case kLookAhead:
    case kLookRight:
      return SentRequest{"look", client.move(msg::kMotionLook, 0.0, 0.0, look_rad)};
    case kWrapLeft:
      return SentRequest{"wrap left", client.move(msg::kMotionWrap, 0.0, 0.0, 1.0)};
    case kWrapRight:
      return SentRequest{"wrap right", client.move(msg::kMotionWrap, 0.0, 0.0, -1.0)};
    case kSqueeze:
      return SentRequest{"squeeze", client.move(msg::kMotionSqueeze)};
    case kOpen:
      return SentRequest{"open", client.move(msg::kMotionOpen)};
    case kEmergencyStop:
      return SentRequest{"emergency stop", client.ask(msg::kRequestEmergencyStop)};
    case kClearStop:
      return SentRequest{"clear stop", client.ask(msg::kRequestClearStop)};
    case kRelease:
      return SentRequest{"release", client.ask(msg::kRequestRelease)};
    default:
      return std::nullopt;
  }
}

}  // namespace constrictor::cli
