// A component that owns a device, such as a serial bus or a camera.
#pragma once

#include <string>

namespace constrictor {

class DeviceOwner {
 public:
  virtual ~DeviceOwner() = default;
  /// The state of the device, for people, in at most 127 characters; the runtime publishes it in ComponentStatus.
  /// Empty: it is not known yet.
  [[nodiscard]] virtual std::string device_status() const = 0;
  /// Whether the device follows the wall clock, so that only a run at real-time pace can drive it.
  [[nodiscard]] virtual bool needs_real_time() const { return false; }
  /// Puts the device to rest. The runtime calls it as soon as no step follows: after the final tick, or when a signal
  /// ends the process. The object itself may live on for seconds, in which the process waits for others. Further calls
  /// do nothing.
  virtual void release_device() {}
};

}  // namespace constrictor
