// The part of ConductorSide that connects a plant with a process outside the barrier: the topics hardware/*.
#include <fmt/format.h>

#include <chrono>

#include "component/hardware_link.hpp"
#include "runtime/conductor_side.hpp"
#include "runtime/member_side.hpp"

namespace constrictor {

void ConductorSide::connect_hardware() {
  const auto link = plant_.hardware_link();
  if (!link) return;
  namespace wire = barrier_topics;
  const dds_entity_t participant = links_.participant();
  const int depth = HardwareLink::kMostSamples;
  // Best effort and volatile: the readers match writers of any quality of service and receive nothing from the past.
  hardware_joints_ = dds::Reader<msg::HardwareJointState>::observer(participant, wire::kHardwareJointState.name, depth);
  hardware_contacts_ =
      dds::Reader<msg::HardwareContactState>::observer(participant, wire::kHardwareContactState.name, depth);
  hardware_imus_ = dds::Reader<msg::HardwareImuState>::observer(participant, wire::kHardwareImuState.name, depth);
  hardware_commands_ = {participant, wire::kHardwareJointCommand};
  const auto take = [this, link](const auto& reader, const char* topic) {
    const auto use = [this, link, topic](const auto& sample) {
      if (sample.robot_id != context_.options.setup.robot_id) return;
      if (const auto violation = validate(sample)) return link->add_refused(fmt::format("{}.{}", topic, *violation));
      link->add(sample);
    };
    // The plant takes what has arrived at its next tick, so samples need not wake the process.
    links_.attach(
        reader.get(), [&reader, use] { reader.take(use); }, Links::Wakes::kIfWanted);
  };
  take(hardware_joints_, wire::kHardwareJointState.name);
  take(hardware_contacts_, wire::kHardwareContactState.name);
  take(hardware_imus_, wire::kHardwareImuState.name);
  const auto send = [this](msg::HardwareJointCommand command) {
    command.robot_id = context_.options.setup.robot_id;
    hardware_commands_.write(command);
  };
  const auto clock = [] {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    return std::int64_t{std::chrono::duration_cast<std::chrono::nanoseconds>(now).count()};
  };
  link->connect(send, clock);
}

}  // namespace constrictor
