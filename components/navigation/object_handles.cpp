#include "navigation/object_handles.hpp"

#include "robot/landmarks.hpp"

namespace constrictor {

const msg::MapObject* named_object(const TaskInput& input) {
  return input.map ? object_of_handle(*input.map, input.parameters.object_handle) : nullptr;
}

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
  const msg::MapObject* object = named_object(input);
  const bool meant = object && (colour == msg::kColourUnknown || object->colour == colour);
  if (named == 0 || meant) return {};
  return "object_handle: found " + std::to_string(named) + ", accepted 0 or an object of this colour in the map";
}

}  // namespace constrictor
