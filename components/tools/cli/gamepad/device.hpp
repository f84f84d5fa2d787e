// Gamepads of this host, and streams of their events.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/gamepad/gamepad.hpp"

namespace constrictor::cli {

/// A gamepad that was found.
struct GamepadCandidate {
  std::filesystem::path device;  ///< "/dev/input/event5"
  std::string name;              ///< "Microsoft X-Box 360 pad"
};

/// The gamepads among the event devices of `folder`: what has a button that Linux calls BTN_GAMEPAD.
[[nodiscard]] std::vector<GamepadCandidate> find_gamepads(const std::filesystem::path& folder = "/dev/input");

/// The device that `wanted` names: a path, or `auto` for the only gamepad. Throws std::runtime_error if there is none,
/// or if there are several; the message lists them.
[[nodiscard]] std::filesystem::path choose_gamepad(const std::string& wanted,
                                                   const std::vector<GamepadCandidate>& candidates);

/// An open event device; or a FIFO or a file with a stream of `struct input_event`, as `cat /dev/input/eventN` writes
/// it, for gamepads that another host sends, and for tests.
class GamepadDevice {
 public:
  /// Opens a device without waiting. Throws std::runtime_error if it cannot be opened, or ConfigurationError if it
  /// lacks an axis or a button of the mapping (of the file `mapping_file`).
  GamepadDevice(const std::filesystem::path& device, const GamepadMapping& mapping, const std::string& mapping_file);
  ~GamepadDevice();
  GamepadDevice(const GamepadDevice&) = delete;
  GamepadDevice& operator=(const GamepadDevice&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }
  /// Ranges of the axes by their code; empty for a stream.
  [[nodiscard]] const std::map<std::uint16_t, AxisRange>& ranges() const { return ranges_; }
  /// Whether the gamepad is there: an open device, or a stream of which an event has arrived.
  [[nodiscard]] bool present() const { return !stream_ || heard_; }
  /// For poll(); readable when there are events, or when the device is gone.
  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// Gives all events that have arrived to `gamepad`. Returns false if the device is gone. A FIFO that no process has
  /// written yet is not gone.
  [[nodiscard]] bool read(Gamepad& gamepad);

 private:
  void check(const GamepadMapping& mapping, const std::string& mapping_file);

  int descriptor_ = -1;
  bool stream_ = false;
  bool heard_ = false;  ///< of a stream: at least one event has arrived
  std::string name_;
  std::map<std::uint16_t, AxisRange> ranges_;
  std::vector<unsigned char> rest_;  ///< of a stream: the first bytes of an event
};

}  // namespace constrictor::cli
