#include "navigation/object_handles.hpp"

#include <algorithm>
#include <span>

#include "robot/landmarks.hpp"

namespace constrictor {
namespace {

std::span<const msg::MapObject> known_landmarks(const TaskInput& input) {
  if (!input.map) return {};
  return landmarks_of(*input.map);
}

}  // namespace

std::uint16_t seen_handle(const TaskInput& input, std::uint8_t colour) {
  return colour < msg::kColourCount ? input.sightings.objects[colour].handle : std::uint16_t{0};
}

bool is_named(const TaskInput& input) {
  const std::uint16_t named = input.parameters.object_handle;
  return named == 0 || seen_handle(input, input.parameters.object_colour) == named;
}

std::string handle_refusal(const TaskInput& input) {
  const std::uint16_t named = input.parameters.object_handle;
  const std::uint8_t colour = input.parameters.object_colour;
  const auto meant = [&](const msg::MapObject& landmark) {
    return landmark.kind == msg::kBlobObject && landmark.handle == named &&
           (colour == msg::kColourUnknown || landmark.colour == colour);
  };
  const auto landmarks = known_landmarks(input);
  if (named == 0 || std::any_of(landmarks.begin(), landmarks.end(), meant)) return {};
  return "object_handle: found " + std::to_string(named) + ", accepted 0 or an object of this colour in the map";
}

}  // namespace constrictor
