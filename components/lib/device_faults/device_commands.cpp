#include "device_faults/device_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>

namespace constrictor {
namespace {

constexpr std::string_view kServos = "servo_emulator", kCamera = "camera_emulator";
constexpr double kLargestId = 252;  // of DYNAMIXEL Protocol 2.0

// README.md of each emulator says what its commands do.
constexpr std::array kCommands = {
    DeviceCommand{kServos, "ambient", "joint", "celsius", -50, 500, false, "heal"},
    DeviceCommand{kServos, "cable", "port", "place", 0, 255, true, "mend"},
    DeviceCommand{kServos, "cut", "port", "probability", 0, 1, false, "mend"},
    DeviceCommand{kServos, "damage", "port", "probability", 0, 1, false, "mend"},
    DeviceCommand{kServos, "error", "joint", "bits", 0, 255, true, ""},
    DeviceCommand{kServos, "feel", "module", "", 0, 0, false, ""},
    DeviceCommand{kServos, "heal", "joint", "", 0, 0, false, ""},
    DeviceCommand{kServos, "hot", "joint", "celsius", -50, 500, false, ""},
    DeviceCommand{kServos, "id", "joint", "id", 0, kLargestId, true, "heal"},
    DeviceCommand{kServos, "mend", "port", "", 0, 0, false, ""},
    DeviceCommand{kServos, "noise", "port", "probability", 0, 1, false, "mend"},
    DeviceCommand{kServos, "numb", "module", "", 0, 0, false, "feel"},
    DeviceCommand{kServos, "reboot", "joint", "", 0, 0, false, ""},
    DeviceCommand{kServos, "silent", "joint", "", 0, 0, false, "heal"},
    DeviceCommand{kServos, "stuck", "joint", "", 0, 0, false, "heal"},
    DeviceCommand{kServos, "unplug", "port", "", 0, 0, false, "mend"},
    DeviceCommand{kServos, "voltage", "joint", "volt", 0, 60, false, "heal"},
    DeviceCommand{kServos, "weak", "joint", "share", 0.01, 1, false, "heal"},
    DeviceCommand{kCamera, "black", "", "", 0, 0, false, "mend"},
    DeviceCommand{kCamera, "blur", "", "pixels", 0, 50, false, "mend"},
    DeviceCommand{kCamera, "delay", "", "seconds", 0, 10, false, "mend"},
    DeviceCommand{kCamera, "drop", "", "probability", 0, 1, false, "mend"},
    DeviceCommand{kCamera, "freeze", "", "", 0, 0, false, "mend"},
    DeviceCommand{kCamera, "jitter", "", "seconds", 0, 10, false, "mend"},
    DeviceCommand{kCamera, "mend", "", "", 0, 0, false, ""},
    DeviceCommand{kCamera, "off", "", "", 0, 0, false, "on"},
    DeviceCommand{kCamera, "on", "", "", 0, 0, false, ""},
    DeviceCommand{kCamera, "silent", "", "", 0, 0, false, "mend"},
};

std::string upper(std::string_view text) {
  std::string made(text);
  for (char& letter : made) letter = static_cast<char>(std::toupper(static_cast<unsigned char>(letter)));
  return made;
}

/// "weak JOINT SHARE"
std::string usage_of(const DeviceCommand& command) {
  std::string text(command.name);
  for (const std::string_view word : {command.of, command.value})
    if (!word.empty()) text += " " + upper(word);
  return text;
}

}  // namespace

std::vector<std::string> breakable_devices() { return {std::string(kCamera), std::string(kServos)}; }

std::vector<const DeviceCommand*> commands_of(std::string_view device) {
  std::vector<const DeviceCommand*> commands;
  for (const DeviceCommand& command : kCommands)
    if (command.device == device) commands.push_back(&command);
  return commands;
}

std::variant<DeviceOrder, std::string> read_order(std::string_view device, const std::string& line,
                                                  const std::function<std::size_t(std::string_view of)>& count) {
  std::istringstream words(line);
  std::string name;
  words >> name;
  const auto commands = commands_of(device);
  const auto found = std::find_if(commands.begin(), commands.end(), [&](const auto* one) { return one->name == name; });
  if (found == commands.end()) {
    std::string accepted;
    for (const auto* command : commands) accepted += (accepted.empty() ? "" : ", ") + usage_of(*command);
    return fmt::format("found '{}', accepted {}", name, accepted);
  }
  const DeviceCommand& command = **found;
  const std::size_t known = command.of.empty() ? 0 : count(command.of);
  double index = 0.0, value = 0.0;
  const bool read = (command.of.empty() || (words >> index)) && (command.value.empty() || (words >> value)) &&
                    (words >> std::ws).eof();
  const bool indexed =
      command.of.empty() || (index >= 0 && index == std::floor(index) && index < static_cast<double>(known));
  const bool valued = command.value.empty() ||
                      (value >= command.min && value <= command.max && (!command.whole || value == std::floor(value)));
  if (read && indexed && valued) return DeviceOrder{&command, static_cast<std::size_t>(index), value};
  std::string ranges;
  if (!command.of.empty())
    ranges = known == 0 ? fmt::format(" (there is no {})", command.of) : fmt::format(" with 0 to {}", known - 1);
  if (!command.value.empty())
    ranges += fmt::format("{} {} to {}", ranges.empty() ? " with" : " and", command.min, command.max);
  return fmt::format("found '{}', accepted {}{}", line, usage_of(command), ranges);
}

std::string line_of(const DeviceOrder& order) {
  std::string line(order.command->name);
  if (!order.command->of.empty()) line += fmt::format(" {}", order.index);
  if (!order.command->value.empty()) line += fmt::format(" {}", order.value);
  return line;
}

std::string end_of(const DeviceOrder& order) {
  if (order.command->end.empty()) return {};
  std::string line(order.command->end);
  if (!order.command->of.empty()) line += fmt::format(" {}", order.index);
  return line;
}

}  // namespace constrictor
