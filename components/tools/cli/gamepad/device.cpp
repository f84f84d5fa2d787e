#include "cli/gamepad/device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <libevdev/libevdev.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "configuration/configuration.hpp"
#include "constrictor/text.hpp"

namespace constrictor::cli {
namespace {

namespace fs = std::filesystem;

struct FreeDevice {
  void operator()(libevdev* device) const { libevdev_free(device); }
};
using Device = std::unique_ptr<libevdev, FreeDevice>;

/// The kernel's description of an open event device; null if it is none.
Device described(int descriptor) {
  libevdev* device = nullptr;
  if (libevdev_new_from_fd(descriptor, &device) != 0) return nullptr;
  return Device(device);
}

std::string name_of(const Device& device) {
  const char* name = libevdev_get_name(device.get());
  return printable(name && *name ? name : "gamepad without a name");
}

}  // namespace

std::vector<GamepadCandidate> find_gamepads(const fs::path& folder) {
  std::vector<GamepadCandidate> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (!entry.path().filename().string().starts_with("event")) continue;
    const int descriptor = ::open(entry.path().c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    if (const Device device = described(descriptor);
        device && libevdev_has_event_code(device.get(), EV_KEY, BTN_GAMEPAD))
      found.push_back({entry.path(), name_of(device)});
    ::close(descriptor);
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.device < b.device; });
  return found;
}

fs::path choose_gamepad(const std::string& wanted, const std::vector<GamepadCandidate>& candidates) {
  if (wanted != "auto") return wanted;
  if (candidates.size() == 1) return candidates.front().device;
  if (candidates.empty())
    throw std::runtime_error(
        "--gamepad auto: found no gamepad in /dev/input, accepted one that this user may read (is it connected? are "
        "you in the group `input`?), or the path of a device");
  std::string list;
  for (const auto& candidate : candidates)
    list += fmt::format("\n  --gamepad {}  ({})", candidate.device.string(), candidate.name);
  throw std::runtime_error(
      fmt::format("--gamepad auto: found {} gamepads, accepted one; choose it:{}", candidates.size(), list));
}

GamepadDevice::GamepadDevice(const fs::path& device, const GamepadMapping& mapping, const std::string& mapping_file) {
  descriptor_ = ::open(device.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  struct stat status {};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    const std::string why = ::strerrordesc_np(errno);
    throw std::runtime_error(fmt::format("{}: cannot be opened: {}", device.string(), why));
  }
  stream_ = !S_ISCHR(status.st_mode);
  name_ = device.string();
  try {
    if (!stream_) check(mapping, mapping_file);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

GamepadDevice::~GamepadDevice() { ::close(descriptor_); }

void GamepadDevice::check(const GamepadMapping& mapping, const std::string& mapping_file) {
  const Device device = described(descriptor_);
  if (!device) throw std::runtime_error(fmt::format("{}: found no event device, accepted a gamepad", name_));
  name_ = fmt::format("{} ({})", name_of(device), name_);
  for (std::uint16_t code = 0; code < ABS_CNT; ++code) {
    if (const input_absinfo* info = libevdev_get_abs_info(device.get(), code))
      ranges_[code] = {info->minimum, info->maximum};
  }
  const auto need = [&](const char* key, unsigned type, std::uint16_t code) {
    if (libevdev_has_event_code(device.get(), type, code)) return;
    std::string has;
    const std::uint16_t count = type == EV_ABS ? ABS_CNT : KEY_CNT;
    for (std::uint16_t other = 0; other < count; ++other) {
      if (libevdev_has_event_code(device.get(), type, other))
        has += (has.empty() ? "" : ", ") + event_code_name(type, other);
    }
    throw ConfigurationError(fmt::format("{}: {}: found '{}', accepted what {} has: {}", mapping_file, key,
                                         event_code_name(type, code), name_, has));
  };
  need("dead_man", EV_KEY, mapping.dead_man);
  need("drive.axis", EV_ABS, mapping.drive.code);
  need("turn.axis", EV_ABS, mapping.turn.code);
  for (const auto& [code, action] : mapping.buttons) need("buttons", EV_KEY, code);
}

bool GamepadDevice::read(Gamepad& gamepad) {
  unsigned char bytes[64 * sizeof(input_event)];
  for (;;) {
    const ssize_t count = ::read(descriptor_, bytes, sizeof(bytes));
    if (count < 0) return errno == EAGAIN || errno == EINTR;
    if (count == 0) return stream_ && !heard_;  // a FIFO without a writer
    rest_.insert(rest_.end(), bytes, bytes + count);
    std::size_t at = 0;
    for (; at + sizeof(input_event) <= rest_.size(); at += sizeof(input_event)) {
      input_event event{};
      std::memcpy(&event, rest_.data() + at, sizeof(event));
      gamepad.take(event.type, event.code, event.value);
      heard_ = true;
    }
    rest_.erase(rest_.begin(), rest_.begin() + static_cast<std::ptrdiff_t>(at));
  }
}

}  // namespace constrictor::cli
