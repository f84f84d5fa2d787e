// The file servo_bus.json in the run's output folder: how the buses and the servos are.
#pragma once

#include "component/device_record.hpp"
#include "servo_bus/joint_servos.hpp"

namespace constrictor {

/// The durations are the times that a tick spent on the buses.
class BusRecord : public DeviceRecord {
 public:
  explicit BusRecord(const std::filesystem::path& folder) : DeviceRecord(folder, "servo_bus.json", "round") {}

  void write(std::int64_t tick, const JointServos& servos, const BusPorts& ports);
};

}  // namespace constrictor
