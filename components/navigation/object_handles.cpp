#include "navigation/object_handles.hpp"

#include <algorithm>
#include <span>

namespace constrictor {
namespace {

std::span<const msg::MapObject> things_of(const TaskInput& input) {
  if (!input.map) return {};
  return {input.map->objects, std::min<std::size_t>(input.map->object_count, msg::kMaxMapObjects)};
}

}  // namespace

std::uint16_t seen_handle(const TaskInput& input, std::uint8_t colour) {
  if (colour >= msg::kColourCount || !input.things.objects[colour].known) return 0;
  std::uint16_t handle = 0;
  double nearest_m = input.config.object.jump_m;
  for (const auto& thing : things_of(input)) {
    if (thing.kind != msg::kBlobObject || thing.colour != colour) continue;
    const double apart_m = (Eigen::Vector2d(thing.x_m, thing.y_m) - input.things.objects[colour].p_M()).norm();
    if (apart_m >= nearest_m) continue;
    nearest_m = apart_m;
    handle = thing.handle;
  }
  return handle;
}

bool is_named(const TaskInput& input) {
  const std::uint16_t named = input.parameters.object_handle;
  return named == 0 || seen_handle(input, input.parameters.object_colour) == named;
}

std::string handle_refusal(const TaskInput& input) {
  const std::uint16_t named = input.parameters.object_handle;
  const std::uint8_t colour = input.parameters.object_colour;
  const auto meant = [&](const msg::MapObject& thing) {
    return thing.kind == msg::kBlobObject && thing.handle == named && (colour == msg::kColourUnknown || thing.colour == colour);
  };
  const auto things = things_of(input);
  if (named == 0 || std::any_of(things.begin(), things.end(), meant)) return {};
  return "object_handle: found " + std::to_string(named) + ", accepted 0 or an object of this colour in the map";
}

}  // namespace constrictor
