// The part of EmulatedRobot that obeys the commands by which people and tests break the robot.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "dynamixel/protocol.hpp"
#include "sim/servo_emulator/emulated_robot.hpp"

namespace constrictor::servo_emulator {
namespace {

enum class Of { kPort, kJoint };

struct Command {
  Of of;                   ///< what the first number names
  const char* value_name;  ///< of the second number; null: there is none
  double min, max;         ///< of the second number
  bool whole;
};

const std::map<std::string, Command>& commands() {
  static const std::map<std::string, Command> known = {
      {"cable", {Of::kPort, "PLACE", 0, 255, true}},
      {"silent", {Of::kJoint, nullptr, 0, 0, false}},
      {"damage", {Of::kPort, "PROBABILITY", 0, 1, false}},
      {"cut", {Of::kPort, "PROBABILITY", 0, 1, false}},
      {"noise", {Of::kPort, "PROBABILITY", 0, 1, false}},
      {"mend", {Of::kPort, nullptr, 0, 0, false}},
      {"id", {Of::kJoint, "ID", 0, dynamixel::kLargestId, true}},
      {"reboot", {Of::kJoint, nullptr, 0, 0, false}},
      {"error", {Of::kJoint, "BITS", 0, 255, true}},
      {"voltage", {Of::kJoint, "VOLT", 0, 60, false}},
      {"ambient", {Of::kJoint, "CELSIUS", -50, 500, false}},
  };
  return known;
}

std::string usage_of(const std::string& name, const Command& command) {
  return fmt::format("{} {}{}{}", name, command.of == Of::kPort ? "PORT" : "JOINT", command.value_name ? " " : "",
                     command.value_name ? command.value_name : "");
}

}  // namespace

std::string EmulatedRobot::command(const std::string& line) {
  std::istringstream words(line);
  std::string name;
  words >> name;
  const auto found = commands().find(name);
  if (found == commands().end()) {
    std::string accepted;
    for (const auto& [other, command] : commands())
      accepted += (accepted.empty() ? "" : ", ") + usage_of(other, command);
    return fmt::format("found '{}', accepted {}", name, accepted);
  }
  const Command& command = found->second;
  const std::size_t count = command.of == Of::kPort ? lines_.size() : servos_.size();
  double first = -1.0;
  double value = 0.0;
  const bool read = (words >> first) && (!command.value_name || (words >> value)) && (words >> std::ws).eof();
  const bool fits = first >= 0 && first == std::floor(first) && first < static_cast<double>(count) &&
                    (!command.value_name || (value >= command.min && value <= command.max)) &&
                    (!command.whole || value == std::floor(value));
  if (!read || !fits)
    return fmt::format("found '{}', accepted {} with 0 to {}{}", line, usage_of(name, command), count - 1,
                       command.value_name ? fmt::format(" and {} to {}", command.min, command.max) : "");
  const auto index = static_cast<std::size_t>(first);
  LineFaults& faults = lines_[command.of == Of::kPort ? index : plan_.joints[index].port]->faults;
  const auto place_of = [&](std::size_t joint) {
    const auto& chain = chains_[plan_.joints[joint].port];
    std::size_t place = 0;
    while (chain[place] != servos_[joint].get()) ++place;
    return place;
  };
  if (name == "cable") break_cable(index, static_cast<std::size_t>(value));
  else if (name == "silent") faults.silent.push_back(place_of(index));
  else if (name == "damage") faults.damaged_bytes = value;
  else if (name == "cut") faults.cut_answers = value;
  else if (name == "noise") faults.noise_answers = value;
  else if (name == "mend") faults = {};
  else if (name == "id") servos_[index]->set("id", static_cast<std::int64_t>(value));
  else if (name == "reboot") servos_[index]->reboot();
  else if (name == "error") servos_[index]->fail(static_cast<std::uint8_t>(value));
  else if (name == "voltage") servos_[index]->traits().supply_v = value;
  else servos_[index]->traits().ambient_c = value;
  return {};
}

}  // namespace constrictor::servo_emulator
