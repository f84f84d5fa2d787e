#include "cli/gamepad/mapping.hpp"

#include <fmt/format.h>
#include <libevdev/libevdev.h>

#include <utility>
#include <vector>

#include "component/data_path.hpp"
#include "configuration/closest_name.hpp"
#include "configuration/configuration.hpp"

namespace constrictor::cli {
namespace {

constexpr Range kSpeed{0.05, 2.0};
constexpr Range kTurn{0.05, 4.0};
constexpr Range kDeadZone{0.0, 0.9};

const std::pair<const char*, TeleopAction> kActions[] = {{"emergency_stop", TeleopAction::kEmergencyStop},
                                                         {"clear_stop", TeleopAction::kClearStop},
                                                         {"release", TeleopAction::kRelease},
                                                         {"stand", TeleopAction::kStand},
                                                         {"cancel", TeleopAction::kCancel},
                                                         {"look_left", TeleopAction::kLookLeft},
                                                         {"look_ahead", TeleopAction::kLookAhead},
                                                         {"look_right", TeleopAction::kLookRight},
                                                         {"wrap_left", TeleopAction::kWrapLeft},
                                                         {"wrap_right", TeleopAction::kWrapRight},
                                                         {"squeeze", TeleopAction::kSqueeze},
                                                         {"open", TeleopAction::kOpen}};

/// All names of a kind that Linux knows: those that begin with `prefix`.
std::vector<std::string> names_of(unsigned type, unsigned count, const std::string& prefix) {
  std::vector<std::string> names;
  for (unsigned code = 0; code < count; ++code) {
    const char* name = libevdev_event_code_get_name(type, code);
    if (name && std::string(name).starts_with(prefix)) names.emplace_back(name);
  }
  return names;
}

std::uint16_t code_of(Configuration& map, const char* key, unsigned type, const std::string& prefix) {
  const std::string name = map.text(key);
  const int code = name.starts_with(prefix) ? libevdev_event_code_from_name(type, name.c_str()) : -1;
  if (code >= 0) return static_cast<std::uint16_t>(code);
  const bool axis = type == EV_ABS;
  throw map.error(key, fmt::format("found '{}', accepted the name of {} as Linux has it ({}){}", name,
                                   axis ? "an axis" : "a button",
                                   axis ? "ABS_X, ABS_Y, ABS_RX, ABS_RY, ABS_HAT0X, ..." : "BTN_SOUTH, BTN_TL, ...",
                                   did_you_mean(name, names_of(type, axis ? ABS_CNT : KEY_CNT, prefix))));
}

GamepadAxis axis_of(Configuration map, const char* largest, Range accepted) {
  GamepadAxis axis;
  axis.code = code_of(map, "axis", EV_ABS, "ABS_");
  axis.largest = map.number(largest, accepted);
  axis.invert = map.flag("invert", false);
  axis.dead_zone = map.number("dead_zone", kDeadZone, axis.dead_zone);
  axis.minimum = static_cast<std::int32_t>(map.integer("minimum", -1'000'000, 1'000'000, 0));
  axis.maximum = static_cast<std::int32_t>(map.integer("maximum", -1'000'000, 1'000'000, 0));
  if (axis.minimum > axis.maximum)
    throw map.error("maximum",
                    fmt::format("found {}, accepted more than minimum, which is {}", axis.maximum, axis.minimum));
  map.finish();
  return axis;
}

}  // namespace

std::string event_code_name(unsigned type, std::uint16_t code) {
  const char* name = libevdev_event_code_get_name(type, code);
  return name ? name : fmt::format("code {}", code);
}

std::filesystem::path GamepadMapping::default_file() { return data_path("components/tools/cli/gamepad/gamepad.yaml"); }

GamepadMapping GamepadMapping::load(const std::filesystem::path& file) {
  Configuration root = Configuration::load(file);
  GamepadMapping mapping;
  mapping.dead_man = code_of(root, "dead_man", EV_KEY, "BTN_");
  mapping.drive = axis_of(root.section("drive"), "largest_m_s", kSpeed);
  mapping.turn = axis_of(root.section("turn"), "largest_rad_s", kTurn);
  if (mapping.drive.code == mapping.turn.code)
    throw root.error("turn.axis", "found the axis of drive, accepted another one");
  Configuration buttons = root.section("buttons");
  for (const auto& [name, action] : kActions) {
    if (!buttons.has(name)) continue;
    const std::uint16_t code = code_of(buttons, name, EV_KEY, "BTN_");
    if (code == mapping.dead_man) throw buttons.error(name, "found the dead-man button, accepted another one");
    if (!mapping.buttons.emplace(code, action).second)
      throw buttons.error(name, fmt::format("found {}, which has an action already; accepted another button",
                                            event_code_name(EV_KEY, code)));
  }
  buttons.finish();
  if (!buttons.has("emergency_stop"))
    throw root.error("buttons", "found no emergency_stop, accepted with it: a person must be able to stop the robot");
  root.finish();
  return mapping;
}

}  // namespace constrictor::cli
