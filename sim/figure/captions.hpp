// The texts of the figure and the film about an event.
#pragma once

#include <cstdint>
#include <string>

#include "constrictor/constants.hpp"

namespace constrictor::figure {

inline constexpr const char* kTitle = "Line following and whole-body grasping";

/// "green object grasped". `event`: msg::kEvent…, `colour`: msg::kColour….
[[nodiscard]] inline std::string event_caption(std::uint8_t event, std::uint8_t colour) {
  const std::string of = colour == msg::kColourUnknown ? "" : std::string(name_of(constants::kColour, colour)) + " ";
  switch (event) {
    case msg::kEventLineFound:
      return "line found";
    case msg::kEventObjectFound:
      return of + "object found";
    case msg::kEventObjectPregrasped:
      return of + "object pregrasped";
    case msg::kEventObjectGrasped:
      return of + "object grasped";
    case msg::kEventDroppingDone:
      return of + "object dropped";
    default: {
      std::string words = name_of(constants::kEvent, event);
      for (char& c : words) c = c == '_' ? ' ' : c;
      return of.empty() ? words : words + " (" + of.substr(0, of.size() - 1) + ")";
    }
  }
}

}  // namespace constrictor::figure
