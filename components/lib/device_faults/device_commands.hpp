// The commands that break emulated devices: one a line in a device's pipe, and as faults in a file of `run --faults`.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace constrictor {

struct DeviceCommand {
  std::string_view device;  ///< the program that obeys it: "servo_emulator"
  std::string_view name;    ///< "weak"
  std::string_view of;      ///< meaning of its first number: "joint", "module", "port"; empty: it has no such number
  std::string_view value;   ///< the name of its other number: "share"; empty: it has none
  double min = 0.0, max = 0.0;  ///< of that number
  bool whole = false;           ///< that number is a whole one
  std::string_view end;         ///< the command that ends what it does, of the same joint, module or port; empty: none
};

/// A command with its numbers.
struct DeviceOrder {
  const DeviceCommand* command = nullptr;
  std::size_t index = 0;  ///< of the joint, module or port, from 0
  double value = 0.0;
};

/// The devices that can be broken, and the commands of one of them in the order of their names.
[[nodiscard]] std::vector<std::string> breakable_devices();
[[nodiscard]] std::vector<const DeviceCommand*> commands_of(std::string_view device);

/// Reads a line such as "cable 0 7". `count` returns how many joints, modules or ports the device has. Returns the
/// order, or why it is refused: what was found and what is accepted.
[[nodiscard]] std::variant<DeviceOrder, std::string> read_order(
    std::string_view device, const std::string& line, const std::function<std::size_t(std::string_view of)>& count);

/// The line that read_order() reads as this order, and the one that ends it; empty: nothing ends it.
[[nodiscard]] std::string line_of(const DeviceOrder& order);
[[nodiscard]] std::string end_of(const DeviceOrder& order);

}  // namespace constrictor
