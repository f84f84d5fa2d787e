// A component that owns a device, such as a serial bus or a camera.
#pragma once

#include <string>

namespace constrictor {

class DeviceOwner {
 public:
  virtual ~DeviceOwner() = default;
  /// How the device is, for people, in at most 127 characters; the runtime publishes it in ComponentStatus. Empty: it
  /// is not known yet.
  [[nodiscard]] virtual std::string device_status() const = 0;
};

}  // namespace constrictor
