// The part of EmulatedRobot that obeys the commands by which people and tests break the robot.
#include <algorithm>
#include <string_view>
#include <variant>

#include "device_faults/device_commands.hpp"
#include "sim/servo_emulator/emulated_robot.hpp"

namespace constrictor::servo_emulator {

std::string EmulatedRobot::command(const std::string& line) {
  const auto read = read_order("servo_emulator", line, [this](std::string_view of) {
    return of == "port" ? lines_.size() : of == "module" ? contacts_.size() : servos_.size();
  });
  if (const auto* refusal = std::get_if<std::string>(&read)) return *refusal;
  const auto& [known, index, value] = std::get<DeviceOrder>(read);
  if (known->of == "port") break_line(index, known->name, value);
  else if (known->of == "module") contacts_[index]->make_numb(known->name == "numb");
  else break_servo(index, known->name, value);
  return {};
}

void EmulatedRobot::break_line(std::size_t port, std::string_view how, double value) {
  LineFaults& faults = lines_[port]->faults;
  if (how == "cable") break_cable(port, static_cast<std::size_t>(value));
  else if (how == "damage") faults.damaged_bytes = value;
  else if (how == "cut") faults.cut_answers = value;
  else if (how == "noise") faults.noise_answers = value;
  else if (how == "unplug") faults.unplugged = true;
  else if (how == "mend") faults = {};
}

void EmulatedRobot::break_servo(std::size_t joint, std::string_view how, double value) {
  ServoDevice& servo = *servos_[joint];
  const std::size_t port = plan_.joints[joint].port;
  auto& silent = lines_[port]->faults.silent;
  const auto& chain = chains_[port];
  const auto place = static_cast<std::size_t>(std::find(chain.begin(), chain.end(), &servo) - chain.begin());
  if (how == "silent") silent.push_back(place);
  else if (how == "stuck") servo.jam();
  else if (how == "weak") servo.traits().strength = value;
  else if (how == "hot") servo.heat(value);
  else if (how == "id") servo.set("id", static_cast<std::int64_t>(value));
  else if (how == "reboot") servo.reboot();
  else if (how == "error") servo.fail(static_cast<std::uint8_t>(value));
  else if (how == "voltage") servo.traits().supply_v = value;
  else if (how == "ambient") servo.traits().ambient_c = value;
  else if (how == "heal") {
    std::erase(silent, place);
    servo.heal();
  }
}

}  // namespace constrictor::servo_emulator
